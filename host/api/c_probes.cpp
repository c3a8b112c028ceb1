// Probes, tool forces, interpenetrations and picked points in the C API.
#include <algorithm>
#include <utility>
#include <vector>

#include "api/c_call.h"
#include "geometry/wrench.h"

using namespace pliant::api;
using pliant::Error;
using pliant::ErrorCode;

pliant_status pliant_world_probes(pliant_world world, pliant_probe_value* out, size_t count, size_t* needed) {
  return on(world, [&](CWorld& w) {
    check_array(out, count, "pliant_probe_value");
    std::vector<pliant::ProbeValue> now = w.world.probes();
    const std::lock_guard lock(w.mutex);
    w.probes = std::move(now);
    if (needed != nullptr) *needed = w.probes.size();
    for (std::size_t i = 0; i < std::min(count, w.probes.size()); ++i) {
      const pliant::ProbeValue& v = w.probes[i];
      give_struct<pliant_probe_value>({0, v.probe.c_str(), v.quantity.c_str(), v.numbers.data(), v.numbers.size()},
                                      element(out, i));
    }
  });
}

pliant_status pliant_world_tool_forces(pliant_world world, pliant_tool_force* out, size_t count, size_t* needed) {
  return on(world, [&](CWorld& w) {
    check_array(out, count, "pliant_tool_force");
    const std::vector<pliant::ToolForce> now = w.world.tool_forces();
    const std::lock_guard lock(w.mutex);
    if (needed != nullptr) *needed = now.size();
    for (std::size_t i = 0; i < std::min(count, now.size()); ++i) {
      pliant_tool_force force{};
      force.name = w.names.insert(now[i].name).first->c_str();
      std::copy(now[i].position.begin(), now[i].position.end(), force.position);
      std::copy(now[i].turn.begin(), now[i].turn.end(), force.turn);
      copy_wrench(now[i], force);
      force.area = now[i].area;
      force.penetration = now[i].penetration;
      force.parked = now[i].parked ? 1 : 0;
      give_struct<pliant_tool_force>(force, element(out, i));
    }
  });
}

pliant_status pliant_world_blade_forces(pliant_world world, pliant_blade_force* out, size_t count, size_t* needed) {
  return on(world, [&](CWorld& w) {
    check_array(out, count, "pliant_blade_force");
    const std::vector<pliant::BladeForce> now = w.world.blade_forces();
    const std::lock_guard lock(w.mutex);
    if (needed != nullptr) *needed = now.size();
    for (std::size_t i = 0; i < std::min(count, now.size()); ++i) {
      pliant_blade_force f{};
      f.name = w.names.insert(now[i].name).first->c_str();
      std::copy(now[i].a.begin(), now[i].a.end(), f.a);
      std::copy(now[i].b.begin(), now[i].b.end(), f.b);
      copy_wrench(now[i], f);
      f.max_force = now[i].max_force;
      f.work = now[i].work;
      f.fracture = now[i].fracture;
      f.gave_way = now[i].gave_way;
      f.present = now[i].present ? 1 : 0;
      f.pressing = now[i].pressing ? 1 : 0;
      std::copy(now[i].face_force.begin(), now[i].face_force.end(), f.face_force);
      f.face_normal = now[i].face_normal;
      f.face_work = now[i].face_work;
      give_struct<pliant_blade_force>(f, element(out, i));
    }
  });
}

pliant_status pliant_world_tool_surface(pliant_world world, const char* name, double* vertices, size_t vertex_count,
                                        int32_t* triangles, size_t triangle_count, size_t* vertices_needed,
                                        size_t* triangles_needed) {
  return on(world, [&](CWorld& w) {
    need(name, "name");
    if (vertex_count > 0) need(vertices, "vertices");
    if (triangle_count > 0) need(triangles, "triangles");
    const pliant::SurfaceSpec now = w.world.tool_surface(name);
    if (vertices_needed != nullptr) *vertices_needed = now.vertices.size();
    if (triangles_needed != nullptr) *triangles_needed = now.triangles.size();
    for (std::size_t i = 0; i < std::min(vertex_count, now.vertices.size()); ++i) {
      std::copy(now.vertices[i].begin(), now.vertices[i].end(), vertices + 3 * i);
    }
    for (std::size_t i = 0; i < std::min(triangle_count, now.triangles.size()); ++i) {
      std::copy(now.triangles[i].begin(), now.triangles[i].end(), triangles + 3 * i);
    }
  });
}

pliant_status pliant_world_vertex_values(pliant_world world, const char* field, float* out, size_t count, size_t* needed) {
  return on(world, [&](CWorld& w) {
    need(field, "field");
    if (count > 0) need(out, "out");
    const std::vector<float> values = w.world.vertex_values(field);
    if (needed != nullptr) *needed = values.size();
    std::copy_n(values.begin(), std::min(count, values.size()), out);
  });
}

pliant_status pliant_world_interpenetrations(pliant_world world, pliant_interpenetration* out, size_t count, size_t* needed) {
  return on(world, [&](CWorld& w) {
    check_array(out, count, "pliant_interpenetration");
    const std::vector<pliant::Interpenetration> now = w.world.interpenetrations();
    const std::lock_guard lock(w.mutex);
    if (needed != nullptr) *needed = now.size();
    for (std::size_t i = 0; i < std::min(count, now.size()); ++i) {
      pliant_interpenetration found{};
      found.first = w.names.insert(now[i].first).first->c_str();
      found.second = w.names.insert(now[i].second).first->c_str();
      found.volume = now[i].volume;
      std::copy(now[i].centroid.begin(), now[i].centroid.end(), found.centroid);
      std::copy(now[i].area.begin(), now[i].area.end(), found.area);
      found.depth = now[i].depth;
      std::copy(now[i].deepest.begin(), now[i].deepest.end(), found.deepest);
      found.tool = now[i].tool ? 1 : 0;
      give_struct<pliant_interpenetration>(found, element(out, i));
    }
  });
}

pliant_status pliant_world_pick(pliant_world world, const double origin[3], const double direction[3], int* hit,
                                pliant_picked_point* out) {
  return on(world, [&](CWorld& w) {
    need(hit, "hit");
    *hit = 0;
    check_struct(out);
    const auto found = w.world.pick(vector_of(origin, "origin"), vector_of(direction, "direction"));
    if (!found) return;
    *hit = 1;
    pliant_picked_point picked{};
    picked.body = found->body;
    picked.triangle = found->triangle;
    std::copy(found->weights.begin(), found->weights.end(), picked.weights);
    std::copy(found->point.begin(), found->point.end(), picked.point);
    std::copy(found->normal.begin(), found->normal.end(), picked.normal);
    picked.distance = found->distance;
    picked.vertex = found->vertex;
    give_struct(picked, out);
  });
}
