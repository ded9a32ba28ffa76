// What C++ programs for HDAPI include and call of HDU. Returns 0 if the results are right.
#include <HD/hd.h>
#include <HDU/hdu.h>
#include <HDU/hduError.h>
#include <HDU/hduMath.h>
#include <HDU/hduMatrix.h>
#include <HDU/hduQuaternion.h>
#include <HDU/hduVector.h>
#include <HL/hl.h>

#include <cstdio>
#include <sstream>

static int failures;
#define CHECK(condition)                                  \
  do {                                                    \
    if (!(condition)) {                                   \
      std::printf("line %d: %s\n", __LINE__, #condition); \
      ++failures;                                         \
    }                                                     \
  } while (0)

static bool near(const hduVector3Dd& a, const hduVector3Dd& b) {
  return a.distance(b) < 1e-12;
}

int main() {
  const double half_turn = 3.14159265358979323846;
  hduVector3Dd force(3, 0, 4);
  CHECK(force.magnitude() == 5);
  hduVecScaleInPlace(force, 2);
  hduVecNormalizeInPlace(force);
  CHECK(near(force, hduVector3Dd(0.6, 0, 0.8)));
  CHECK(near(normalize(hduVector3Dd(0, 2, 0)), hduVector3Dd(0, 1, 0)));
  CHECK(near(crossProduct(hduVector3Dd(1, 0, 0), hduVector3Dd(0, 1, 0)), hduVector3Dd(0, 0, 1)));
  CHECK(dotProduct(force, force) > 0.999);
  const hduVector3Df small(1, 2, 3);
  CHECK(hduVecMagnitude(static_cast<const float*>(small)) > 3.7f);
  CHECK(near(hduVector3Dd(small), hduVector3Dd(1, 2, 3)));
  std::ostringstream text;
  text << force;
  CHECK(text.str() == "(0.6, 0, 0.8)");

  // A quarter turn about z takes x to y.
  const hduMatrix quarter = hduMatrix::createRotation(0, 0, 1, half_turn / 2);
  CHECK(near(hduVector3Dd(1, 0, 0) * quarter, hduVector3Dd(0, 1, 0)));
  const hduVector3Dd axis(1, 2, -2);
  const hduMatrix turn = hduMatrix::createRotation(axis, 0.7);
  CHECK(near(turn.multDirMatrix(axis), axis));
  hduMatrix back = turn;
  back.transpose();
  const hduVector3Dd p(5, -3, 2);
  CHECK(near(p * turn * back, p));
  // Each applies after the one before.
  hduMatrix moved;
  moved.multRight(quarter).multRight(hduMatrix::createTranslation(10, 0, 0));
  CHECK(near(hduVector3Dd(1, 0, 0) * moved, hduVector3Dd(10, 1, 0)));
  hduMatrix other = hduMatrix::createTranslation(10, 0, 0);
  CHECK(near(hduVector3Dd(1, 0, 0) * other.multLeft(quarter), hduVector3Dd(10, 1, 0)));
  hduVector3Dd to;
  moved.getInverse().multVecMatrix(hduVector3Dd(10, 1, 0), to);
  CHECK(near(to, hduVector3Dd(1, 0, 0)));
  hduMatrix nothing = hduMatrix::createScale(0, 1, 1);
  CHECK(!nothing.invert());
  hduMatrix sixteen(2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 7, 8, 9, 1);
  CHECK(sixteen[3][1] == 8);
  sixteen.getRotationMatrix(sixteen);
  CHECK(sixteen[0][0] == 1 && sixteen[3][1] == 0);

  // The rotation of a transform and back, for each of the four largest components.
  for (const hduVector3Dd& about : {hduVector3Dd(1, 2, -2), hduVector3Dd(1, 0, 0),
                                    hduVector3Dd(0, 1, 0), hduVector3Dd(0, 0, 1)}) {
    for (const double angle : {0.0, 0.3, 2.0, 3.1, half_turn}) {
      const hduMatrix rotation = hduMatrix::createRotation(about, angle);
      const hduQuaternion q(rotation);
      CHECK(std::fabs(q.magnitude() - 1) < 1e-12);
      CHECK(near(p * q.getRotationMatrix(), p * rotation));
      const hduQuaternion same(about, angle);
      CHECK(near(p * same.getRotationMatrix(), p * rotation));
      CHECK(near(p * (q * q).getRotationMatrix(), p * rotation * rotation));
    }
  }
  hduMatrix from_array(hduMatrix::createTranslation(1, 2, 3));
  double array[16];
  for (int i = 0; i < 16; ++i) array[i] = static_cast<double*>(from_array)[i];
  CHECK(hduMatrix(array)[3][2] == 3);
  CHECK(hduIsEqual(hduLerp(1.0, 3.0, 0.5), 2.0, 1e-12) && hduMax(1, 2) == 2 && hduMin(1, 2) == 1);
  const HLerror error = hlGetError();
  CHECK(!HL_ERROR(error));
  std::printf("HDU in C++: %d failures\n", failures);
  return failures != 0;
}
