/* Force laws of the programs, in the units of the caller. */
#ifndef FORCE_LAWS_H
#define FORCE_LAWS_H

#include <math.h>

typedef struct {
  double centre[3], radius, stiffness;
} Sphere;

/* Computes the force that pushes a tip at p out; returns its depth. */
static inline double sphere_force(const Sphere* sphere, const double p[3], double f[3]) {
  double d[3], distance = 0;
  int i;
  for (i = 0; i < 3; ++i) {
    d[i] = p[i] - sphere->centre[i];
    distance += d[i] * d[i];
    f[i] = 0;
  }
  distance = sqrt(distance);
  if (!(distance < sphere->radius) || !(distance > 0)) return 0;
  for (i = 0; i < 3; ++i) {
    f[i] = sphere->stiffness * (sphere->radius - distance) * d[i] / distance;
  }
  return sphere->radius - distance;
}

/* Pulls to an anchor. */
static inline void spring_force(double stiffness, const double anchor[3], const double p[3],
                                double f[3]) {
  int i;
  for (i = 0; i < 3; ++i) f[i] = stiffness * (anchor[i] - p[i]);
}

/* Attracts to the origin by `pull` at the distance `radius` and by the inverse square of the
 * distance beyond; within the radius, in proportion to the distance. */
static inline void coulomb_force(double pull, double radius, const double p[3], double f[3]) {
  const double distance = sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
  const double scale =
      distance > radius ? pull * radius * radius / pow(distance, 3) : pull / radius;
  int i;
  for (i = 0; i < 3; ++i) f[i] = -scale * p[i];
}

/* Pushes up out of the half space below `height` along the axis `up`. */
static inline void plane_force(double stiffness, double height, int up, const double p[3],
                               double f[3]) {
  f[0] = f[1] = f[2] = 0;
  if (p[up] < height) f[up] = stiffness * (height - p[up]);
}

#endif
