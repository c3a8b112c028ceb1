/* The C API from C. */
#include <pliant/c/pliant.h>
#include <stdio.h>

static const char* scene =
    "{\"format\": \"pliant-scene/1\", \"gravity\": [0, -9.81, 0], \"bodies\": [{\"name\": \"block\", \"surface\": \"memory:0\","
    " \"lattice\": {\"spacing\": 0.02}, \"material\": {\"young\": 3000, \"poisson\": 0.45}}]}";

int main(void) {
  const double vertices[8][3] = {{0, 0, 0},   {0.1, 0, 0},   {0, 0.1, 0},   {0.1, 0.1, 0},
                                 {0, 0, 0.1}, {0.1, 0, 0.1}, {0, 0.1, 0.1}, {0.1, 0.1, 0.1}};
  const int32_t triangles[12][3] = {{0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}, {0, 1, 5}, {0, 5, 4},
                                    {2, 6, 7}, {2, 7, 3}, {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}};
  const pliant_surface surface = {sizeof surface, &vertices[0][0], 8, &triangles[0][0], 12};
  pliant_options options = PLIANT_OPTIONS_INIT;
  pliant_world world;
  pliant_report report = PLIANT_REPORT_INIT;
  pliant_frame frame = PLIANT_FRAME_INIT;
  if (pliant_world_parse(scene, NULL, &surface, 1, &options, &world) != PLIANT_OK ||
      pliant_world_step(world, 100, &report) != PLIANT_OK || pliant_world_frame(world, &frame) != PLIANT_OK) {
    fprintf(stderr, "consumer_c: %s\n", pliant_last_error());
    return 1;
  }
  printf("C: pliant %s, t = %g s, the first vertex fell to y = %g m\n", pliant_version(), report.time, frame.positions[1]);
  pliant_world_destroy(world);
  return pliant_world_step(world, 1, NULL) == PLIANT_STATE && frame.step == 100 ? 0 : 1;
}
