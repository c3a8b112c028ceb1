// Handles, tools, cuts and checkpoints of the C API.
#include <algorithm>
#include <array>
#include <vector>

#include "api/c_call.h"

namespace {

using namespace pliant::api;

void give_cut(const pliant::CutResult& r, pliant_cut* out) {
  give_struct({0, r.pending ? 1 : 0, r.changed ? 1 : 0, r.edges, r.seconds, r.in_part, r.elements, r.mass_lost}, out);
}

}  // namespace

pliant_status pliant_world_grab(pliant_world world, int32_t vertex, double radius, double stiffness, double max_force,
                                uint64_t* out) {
  return on(world, [&](CWorld& w) {
    need(out, "out");
    *out = w.world.grab(vertex, {radius, stiffness, max_force});
  });
}
pliant_status pliant_world_move_grab(pliant_world world, uint64_t grab, const double target[3]) {
  return on(world, [&](CWorld& w) { w.world.move_grab(grab, vector_of(target, "target")); });
}
pliant_status pliant_world_grab_state(pliant_world world, uint64_t grab, double force[3], double gap[3], int* limited) {
  return on(world, [&](CWorld& w) {
    const pliant::GrabState state = w.world.grab_state(grab);
    if (force != nullptr) std::copy(state.force.begin(), state.force.end(), force);
    if (gap != nullptr) std::copy(state.gap.begin(), state.gap.end(), gap);
    if (limited != nullptr) *limited = state.limited ? 1 : 0;
  });
}
pliant_status pliant_world_release(pliant_world world, uint64_t grab) {
  return on(world, [&](CWorld& w) { w.world.release(grab); });
}
pliant_status pliant_world_push(pliant_world world, int32_t vertex, const double force[3]) {
  return on(world, [&](CWorld& w) { w.world.push(vertex, vector_of(force, "force")); });
}
pliant_status pliant_world_push_node(pliant_world world, size_t body, int64_t node, const double force[3]) {
  return on(world, [&](CWorld& w) { w.world.push_node(body, node, vector_of(force, "force")); });
}
pliant_status pliant_world_drive_tool(pliant_world world, const char* name, const double position[3], const double turn[4],
                                      double seconds) {
  return on(world, [&](CWorld& w) {
    need(name, "name");
    need(turn, "turn");
    w.world.drive_tool(name, vector_of(position, "position"), {turn[0], turn[1], turn[2], turn[3]}, seconds);
  });
}
pliant_status pliant_world_set_tool_mesh(pliant_world world, const char* name, const pliant_surface* surface, double time) {
  return on(world, [&](CWorld& w) {
    need(name, "name");
    need(surface, "surface");
    w.world.set_tool_mesh(name, surface_of(*surface), time);
  });
}
pliant_status pliant_world_parse_tool(pliant_world world, const char* tool_text, const char* folder, char* name, size_t size) {
  return on(world, [&](CWorld& w) {
    need(tool_text, "tool_text");
    if (size > 0) need(name, "name");
    const std::string given = w.world.parse_tool(tool_text, folder == nullptr ? "" : folder);
    if (size > 0) name[given.copy(name, size - 1)] = 0;
  });
}
pliant_status pliant_world_parse_change(pliant_world world, const char* change_text) {
  return on(world, [&](CWorld& w) {
    need(change_text, "change_text");
    w.world.parse_change(change_text);
  });
}
pliant_status pliant_world_remove_tool(pliant_world world, const char* name) {
  return on(world, [&](CWorld& w) {
    need(name, "name");
    w.world.remove_tool(name);
  });
}
pliant_status pliant_world_park_tool(pliant_world world, const char* name) {
  return on(world, [&](CWorld& w) {
    need(name, "name");
    w.world.park_tool(name);
  });
}
pliant_status pliant_world_unpark_tool(pliant_world world, const char* name) {
  return on(world, [&](CWorld& w) {
    need(name, "name");
    w.world.unpark_tool(name);
  });
}
pliant_status pliant_world_grip_tool(pliant_world world, const char* name, int hold) {
  return on(world, [&](CWorld& w) {
    need(name, "name");
    w.world.grip_tool(name, hold != 0);
  });
}
pliant_status pliant_world_place_tool(pliant_world world, const char* name, const double position[3], const double turn[4]) {
  return on(world, [&](CWorld& w) {
    need(name, "name");
    need(turn, "turn");
    w.world.place_tool(name, vector_of(position, "position"), {turn[0], turn[1], turn[2], turn[3]});
  });
}
pliant_status pliant_world_move_focus(pliant_world world, const double position[3]) {
  return on(world, [&](CWorld& w) { w.world.move_focus(vector_of(position, "position")); });
}
pliant_status pliant_world_clear_handles(pliant_world world) {
  return on(world, [&](CWorld& w) { w.world.clear_handles(); });
}

pliant_status pliant_world_cut(pliant_world world, const double* triangles, size_t triangle_count, pliant_cut* out) {
  return on(world, [&](CWorld& w) {
    if (triangle_count > 0) need(triangles, "triangles");
    check_struct(out);
    std::vector<std::array<pliant::Vec3d, 3>> copies(triangle_count);
    for (auto& t : copies) {
      for (pliant::Vec3d& corner : t) corner = {*triangles++, *triangles++, *triangles++};
    }
    give_cut(w.world.cut(copies), out);
  });
}
pliant_status pliant_world_move_blade(pliant_world world, const char* blade, const double a[3], const double b[3],
                                      pliant_cut* out) {
  return on(world, [&](CWorld& w) {
    need(blade, "blade");
    check_struct(out);
    give_cut(w.world.move_blade(blade, vector_of(a, "a"), vector_of(b, "b")), out);
  });
}
pliant_status pliant_world_lift_blade(pliant_world world, const char* blade) {
  return on(world, [&](CWorld& w) {
    need(blade, "blade");
    w.world.lift_blade(blade);
  });
}
pliant_status pliant_world_drive_blade(pliant_world world, const char* blade, const double a[3], const double b[3],
                                       double seconds) {
  return on(world, [&](CWorld& w) {
    need(blade, "blade");
    w.world.drive_blade(blade, vector_of(a, "a"), vector_of(b, "b"), seconds);
  });
}
pliant_status pliant_world_pieces(pliant_world world, size_t body, int64_t* out) {
  return on(world, [&](CWorld& w) {
    need(out, "out");
    *out = w.world.pieces(body);
  });
}

pliant_status pliant_world_save(pliant_world world, const char* file) {
  return on(world, [&](CWorld& w) {
    need(file, "file");
    w.world.save(file);
  });
}
pliant_status pliant_world_load(pliant_world world, const char* file) {
  return on(world, [&](CWorld& w) {
    need(file, "file");
    w.world.load(file);
    w.forget_attempts();
  });
}
pliant_status pliant_world_reset(pliant_world world) {
  return on(world, [&](CWorld& w) {
    w.world.reset();
    w.forget_attempts();
  });
}
