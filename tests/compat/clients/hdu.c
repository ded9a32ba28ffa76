/* What C programs for HDAPI include and call of HDU and HL. Returns 0 if the results are right. */
#include <HD/hd.h>
#include <HD/hdDevice.h>
#include <HD/hdScheduler.h>
#include <HDU/hdu.h>
#include <HDU/hduError.h>
#include <HDU/hduMath.h>
#include <HDU/hduVector.h>
#include <HL/hl.h>
#include <stdio.h>
#include <string.h>

#include "count_failures.h"

int main(void) {
  const hduVector3Dd anchor = {10, 0, -5};
  hduVector3Dd position = {7, 4, -5}, force, normal;
  HLerror error;
  hduVecSubtract(force, anchor, position);
  CHECK(hduVecMagnitude(force) == 5);
  hduVecScaleInPlace(force, 0.5);
  CHECK(force[0] == 1.5 && force[1] == -2 && force[2] == 0);
  hduVecNormalize(normal, force);
  CHECK(hduIsEqual(normal[0], 0.6, 1e-12) && hduIsEqual(normal[1], -0.8, 1e-12));
  hduVecNormalizeInPlace(force);
  CHECK(hduVecDistance(force, normal) == 0);
  hduVecSet(position, 0, 0, 1);
  hduVecCrossProduct(force, normal, position);
  CHECK(hduIsEqual(force[0], -0.8, 1e-12) && hduIsEqual(force[1], -0.6, 1e-12));
  CHECK(hduVecDotProduct(force, position) == 0);
  hduVecAddInPlace(force, position);
  hduVecSubtractInPlace(force, position);
  hduVecAdd(force, force, position);
  hduVecScale(force, force, 2);
  CHECK(force[2] == 2);
  memset(force, 0, sizeof(hduVector3Dd));
  hduVecNormalizeInPlace(force);
  CHECK(force[0] == 0);
  CHECK(hlCreateContext(hdGetCurrentDevice()) == 0);
  error = hlGetError();
  CHECK(HL_ERROR(error) && error.errorCode == HL_DEVICE_ERROR);
  CHECK(error.errorInfo.errorCode == HD_INVALID_OPERATION);
  error = hlGetError();
  CHECK(!HL_ERROR(error));
  printf("HDU in C: %d failures\n", failures);
  return failures != 0;
}
