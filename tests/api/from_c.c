/* A hand presses a block and feels it, in C99: what a program in C needs of include/pliant/c. */
#include <pliant/c/pliant.h>
#include <stdio.h>

static void read_hand(void* user, pliant_device_sample* sample) {
  const double* const height = (const double*)user;
  sample->position[1] = *height;
  sample->number += 1;
}

static void write_hand(void* user, const pliant_device_wrench* wrench) {
  (void)user;
  (void)wrench->force;
}

int main(void) {
  static const pliant_options options = PLIANT_OPTIONS_INIT;
  static double height = -0.004;
  pliant_world world = {0};
  pliant_haptic_device callbacks = {0}, manual = {0};
  pliant_haptic_loop loop = {0};
  pliant_haptic_options touch = PLIANT_HAPTIC_OPTIONS_INIT;
  pliant_haptic_state state = PLIANT_HAPTIC_STATE_INIT;
  pliant_haptic_sample last = PLIANT_HAPTIC_SAMPLE_INIT;
  pliant_device_callbacks hand = PLIANT_DEVICE_CALLBACKS_INIT;
  const pliant_device_limits limits = PLIANT_DEVICE_LIMITS_INIT;
  const pliant_device_sample none = PLIANT_DEVICE_SAMPLE_INIT;
  pliant_device_wrench wrench = PLIANT_DEVICE_WRENCH_INIT;
  pliant_device_counts counts = PLIANT_DEVICE_COUNTS_INIT;
  hand.user = &height;
  hand.read = read_hand;
  hand.write = write_hand;
  touch.rate = 500;
  if (pliant_world_open("scenes/liver.json", &options, &world) != PLIANT_OK ||
      pliant_manual_device_create(&limits, &manual) != PLIANT_OK ||
      pliant_manual_device_set_pose(manual, none.position, none.turn, 0) != PLIANT_OK ||
      pliant_manual_device_wrench(manual, &wrench) != PLIANT_OK ||
      pliant_haptic_device_create(&hand, NULL, &callbacks) != PLIANT_OK ||
      pliant_haptic_loop_create(world, "probe", callbacks, &touch, &loop) != PLIANT_OK ||
      pliant_haptic_loop_state(loop, &state, &last) != PLIANT_OK ||
      pliant_haptic_device_counts(callbacks, &counts) != PLIANT_OK) {
    fprintf(stderr, "%s\n", pliant_last_error());
    return 1;
  }
  printf("%s: %g N, %d samples\n", state.model, last.force[1], (int)counts.received);
  pliant_haptic_loop_destroy(loop);
  pliant_haptic_device_destroy(callbacks);
  pliant_haptic_device_destroy(manual);
  return pliant_world_destroy(world) == PLIANT_OK ? 0 : 1;
}
