/* What the hello programs share besides their sphere: their log and their command line. */
#ifndef SPHERE_H
#define SPHERE_H

#include <stdio.h>
#include <stdlib.h>

#include "force_laws.h"

/* The requested forces, in memory until the program ends. */
typedef struct {
  double (*all)[3];
  long count, room;
} ForceLog;

static void log_force(ForceLog* log, const double f[3]) {
  int i;
  if (log->count >= log->room) return;
  for (i = 0; i < 3; ++i) log->all[log->count][i] = f[i];
  ++log->count;
}

/* The command line: [SECONDS [LOG [X Y Z]]]. LOG gets the forces, one per line, in the program's
 * axes; X Y Z is the centre of the sphere. */
typedef struct {
  double seconds;
  const char* log_file;
} SphereChoice;

static SphereChoice sphere_choice(int argc, char** argv, Sphere* sphere, ForceLog* log) {
  SphereChoice choice = {3.5, 0};
  int i;
  if (argc > 1) choice.seconds = atof(argv[1]);
  if (argc > 2) choice.log_file = argv[2];
  for (i = 0; i < 3 && argc > 5; ++i) sphere->centre[i] = atof(argv[3 + i]);
  log->room = choice.log_file ? (long)(2000 * choice.seconds) + 1 : 0;
  log->all = malloc((size_t)(log->room + 1) * sizeof *log->all);
  return choice;
}

/* Returns 0 if all forces were written to the file. */
static int write_forces(const ForceLog* log, const char* file_name) {
  FILE* file;
  long i;
  if (!file_name) return 0;
  file = fopen(file_name, "w");
  if (!file) return 1;
  for (i = 0; i < log->count; ++i) {
    fprintf(file, "%.17g %.17g %.17g\n", log->all[i][0], log->all[i][1], log->all[i][2]);
  }
  return fclose(file);
}

#endif
