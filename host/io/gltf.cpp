#include "io/gltf.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "io/atomic_file.h"
#include "pliant/error.h"

namespace pliant {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kFloat = 5126, kUint = 5125, kVertexTarget = 34962, kIndexTarget = 34963;

/// The binary chunk and what the JSON says about it.
class Blob {
 public:
  /// Returns the number of the accessor. `components` 1 to 3; bounds are required for positions and times.
  std::size_t floats(const std::vector<float>& values, std::size_t components, bool vertices, bool bounds) {
    constexpr const char* types[]{"SCALAR", "VEC2", "VEC3"};
    Json accessor = {{"componentType", kFloat}, {"count", values.size() / components}, {"type", types[components - 1]}};
    if (bounds) {
      std::vector<float> low(components, HUGE_VALF), high(components, -HUGE_VALF);
      for (std::size_t i = 0; i < values.size(); ++i) {
        low[i % components] = std::min(low[i % components], values[i]);
        high[i % components] = std::max(high[i % components], values[i]);
      }
      accessor["min"] = low;
      accessor["max"] = high;
    }
    return add(values.data(), values.size() * sizeof(float), vertices ? kVertexTarget : 0, accessor);
  }
  std::size_t indices(const std::vector<std::int32_t>& values) {
    return add(values.data(), values.size() * sizeof(std::int32_t), kIndexTarget,
               {{"componentType", kUint}, {"count", values.size()}, {"type", "SCALAR"}});
  }

  std::string bytes;
  Json views = Json::array(), accessors = Json::array();

 private:
  std::size_t add(const void* data, std::size_t size, int target, Json accessor) {
    Json view = {{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", size}};
    if (target != 0) view["target"] = target;
    bytes.append(static_cast<const char*>(data), size);  // all types have four bytes: always aligned
    accessor["bufferView"] = views.size();
    views.push_back(view);
    accessors.push_back(accessor);
    return accessors.size() - 1;
  }
};

using Part = SurfaceAnimation::Part;

/// Which frames of each part are written: all, or an even choice that keeps the first and last of each part.
std::vector<std::vector<std::size_t>> chosen_frames(const std::vector<Part>& parts) {
  std::size_t all = 0;
  for (const Part& p : parts) all += p.times.size();
  const std::size_t stride = (all + kMostFrames - 1) / kMostFrames;
  std::vector<std::vector<std::size_t>> chosen;
  for (const Part& p : parts) {
    std::vector<std::size_t> frames;
    for (std::size_t i = 0; i < p.times.size(); i += stride) frames.push_back(i);
    if (frames.back() + 1 != p.times.size()) frames.push_back(p.times.size() - 1);
    chosen.push_back(std::move(frames));
  }
  return chosen;
}

std::vector<float> difference(const std::vector<float>& a, const std::vector<float>& b) {
  std::vector<float> d(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) d[i] = a[i] - b[i];
  return d;
}

/// The name that glTF 2.0 (3.7.2.1) asks of what an application adds: an underscore, and capitals.
std::string attribute_of(const VertexArray& field) {
  std::string name = "_" + field.name;
  for (char& c : name) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return name;
}

Json mesh_of(Blob& blob, const Part& part, const std::vector<std::size_t>& frames) {
  Json targets = Json::array();
  for (std::size_t i = 1; i < frames.size(); ++i) {
    const std::size_t at = frames[i], from = frames[0];
    targets.push_back({{"POSITION", blob.floats(difference(part.positions[at], part.positions[from]), 3, true, true)},
                       {"NORMAL", blob.floats(difference(part.normals[at], part.normals[from]), 3, true, false)}});
    for (std::size_t f = 0; f < part.fields[at].size(); ++f) {
      const VertexArray& field = part.fields[at][f];
      targets.back()[attribute_of(field)] = blob.floats(difference(field.values, part.fields[from][f].values),
                                                        static_cast<std::size_t>(field.components), true, false);
    }
  }
  const std::size_t position = blob.floats(part.positions[frames[0]], 3, true, true);
  Json attributes = {{"POSITION", position}, {"NORMAL", blob.floats(part.normals[frames[0]], 3, true, false)}};
  if (!part.texture.empty()) {
    std::vector<float> from_above = part.texture;
    for (std::size_t i = 1; i < from_above.size(); i += 2) from_above[i] = 1 - from_above[i];
    attributes["TEXCOORD_0"] = blob.floats(from_above, 2, true, false);
  }
  for (const VertexArray& field : part.fields[frames[0]]) {
    attributes[attribute_of(field)] = blob.floats(field.values, static_cast<std::size_t>(field.components), true, false);
  }
  Json primitives = Json::array();
  for (const bool cut : {false, true}) {
    std::vector<std::int32_t> corners;
    for (std::size_t t = 0; t < part.triangles.size() / 3; ++t) {
      if ((!part.cut.empty() && part.cut[t] != 0) != cut) continue;
      corners.insert(corners.end(), {part.triangles[3 * t], part.triangles[3 * t + 1], part.triangles[3 * t + 2]});
    }
    if (corners.empty()) continue;
    Json primitive = {{"attributes", attributes}, {"indices", blob.indices(corners)}, {"material", cut ? 1 : 0}};
    if (!targets.empty()) primitive["targets"] = targets;
    primitives.push_back(primitive);
  }
  Json mesh = {{"name", fmt::format("surface {}", part.topology)}, {"primitives", primitives}};
  if (!targets.empty()) mesh["weights"] = std::vector<int>(targets.size(), 0);
  return mesh;
}

/// Every frame's own target has weight 1 when it is due, all others 0.
void animate_weights(Blob& blob, Json& animation, std::size_t node, const Part& part, const std::vector<std::size_t>& frames,
                     double start) {
  if (frames.size() < 2) return;
  const std::size_t targets = frames.size() - 1;
  std::vector<float> times, weights;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    times.push_back(static_cast<float>(part.times[frames[i]] - start));
    for (std::size_t t = 0; t < targets; ++t) weights.push_back(i == t + 1 ? 1.0F : 0.0F);
  }
  animation["channels"].push_back(
      {{"sampler", animation["samplers"].size()}, {"target", {{"node", node}, {"path", "weights"}}}});
  animation["samplers"].push_back({{"input", blob.floats(times, 1, false, true)},
                                   {"output", blob.floats(weights, 1, false, false)},
                                   {"interpolation", "LINEAR"}});
}

/// Present from its first frame to that of the next part.
void animate_presence(Blob& blob, Json& animation, std::size_t node, const std::vector<Part>& parts, std::size_t p) {
  if (parts.size() < 2) return;
  std::vector<float> times, scales;
  const auto key = [&](double time, float scale) {
    times.push_back(static_cast<float>(time - parts[0].times[0]));
    scales.insert(scales.end(), 3, scale);
  };
  if (p > 0) key(parts[0].times[0], 0);
  key(parts[p].times[0], 1);
  if (p + 1 < parts.size()) key(parts[p + 1].times[0], 0);
  animation["channels"].push_back({{"sampler", animation["samplers"].size()}, {"target", {{"node", node}, {"path", "scale"}}}});
  animation["samplers"].push_back({{"input", blob.floats(times, 1, false, true)},
                                   {"output", blob.floats(scales, 3, false, false)},
                                   {"interpolation", "STEP"}});
}

Json material(const char* name, std::array<double, 3> color, double roughness) {
  return {{"name", name},
          {"pbrMetallicRoughness",
           {{"baseColorFactor", {color[0], color[1], color[2], 1.0}}, {"metallicFactor", 0.0}, {"roughnessFactor", roughness}}},
          {"doubleSided", true}};
}

bool same_fields(const std::vector<VertexArray>& a, const std::vector<VertexArray>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const VertexArray& x, const VertexArray& y) {
    return x.name == y.name && x.components == y.components && x.values.size() == y.values.size();
  });
}

/// `type`: the characters JSON, or BIN and a zero.
void append_chunk(std::string& file, std::uint32_t type, const std::string& content) {
  const std::uint32_t head[2] = {static_cast<std::uint32_t>(content.size()), type};
  file.append(reinterpret_cast<const char*>(head), 8);
  file += content;
}

}  // namespace

void SurfaceAnimation::add(SurfaceFrame frame) {
  const auto require = [](bool fits, const char* what) {
    if (!fits) throw Error(ErrorCode::internal, fmt::format("animated surface: {}", what));
  };
  require(frame.normals.size() == frame.positions.size(), "as many normals as positions");
  require(frame.cut.empty() || 3 * frame.cut.size() == frame.triangles.size(), "as many cut flags as triangles");
  require(parts_.empty() || frame.time > parts_.back().times.back(), "times must ascend");
  if (parts_.empty() || parts_.back().topology != frame.topology) {
    require(frame.texture.empty() || 3 * frame.texture.size() == 2 * frame.positions.size(), "two coordinates per vertex");
    parts_.push_back(
        {frame.topology, std::move(frame.triangles), std::move(frame.cut), std::move(frame.texture), {}, {}, {}, {}});
  } else {
    require(frame.positions.size() == parts_.back().positions[0].size(), "as many vertices as in the frame before");
    require(same_fields(frame.fields, parts_.back().fields[0]), "the same fields as in the frame before");
  }
  for (const VertexArray& field : frame.fields) {
    require(3 * field.values.size() == static_cast<std::size_t>(field.components) * frame.positions.size(),
            "a value of each field per vertex");
  }
  Part& part = parts_.back();
  part.times.push_back(frame.time);
  part.positions.push_back(std::move(frame.positions));
  part.normals.push_back(std::move(frame.normals));
  part.fields.push_back(std::move(frame.fields));
}

void write_glb(const std::filesystem::path& file, const SurfaceAnimation& animation) {
  const std::vector<Part>& parts = animation.parts();
  if (parts.empty()) throw Error(ErrorCode::internal, fmt::format("cannot write '{}': no frame", file.string()));
  Blob blob;
  Json meshes = Json::array(), nodes = Json::array(), roots = Json::array();
  Json motion = {{"name", "simulation"}, {"channels", Json::array()}, {"samplers", Json::array()}};
  const auto chosen = chosen_frames(parts);
  for (std::size_t p = 0; p < parts.size(); ++p) {
    meshes.push_back(mesh_of(blob, parts[p], chosen[p]));
    Json node = {{"name", fmt::format("body {}", p)}, {"mesh", p}};
    if (p > 0) node["scale"] = {0, 0, 0};
    nodes.push_back(node);
    roots.push_back(p);
    animate_weights(blob, motion, p, parts[p], chosen[p], parts[0].times[0]);
    animate_presence(blob, motion, p, parts, p);
  }
  Json top = {{"asset", {{"version", "2.0"}, {"generator", "Pliant"}}},
              {"scene", 0},
              {"scenes", {{{"nodes", roots}}}},
              {"nodes", nodes},
              {"meshes", meshes},
              {"materials", {material("tissue", {0.34, 0.051, 0.036}, 0.35), material("cut", {0.62, 0.24, 0.19}, 0.3)}},
              {"buffers", {{{"byteLength", blob.bytes.size()}}}},
              {"bufferViews", blob.views},
              {"accessors", blob.accessors}};
  if (!motion["channels"].empty()) top["animations"] = {motion};
  std::string text = top.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const std::uint64_t total = 12 + 8 + text.size() + 8 + blob.bytes.size();
  if (total > 0xffffffffULL) {
    throw Error(ErrorCode::bad_input,
                fmt::format("{}: a glTF file holds at most 4 GiB, this one would have {} bytes; write fewer frames (--every)",
                            file.string(), total));
  }
  std::string bytes = "glTF";
  const std::uint32_t head[2] = {2, static_cast<std::uint32_t>(total)};
  bytes.append(reinterpret_cast<const char*>(head), 8);
  append_chunk(bytes, 0x4e4f534a, text);
  append_chunk(bytes, 0x004e4942, blob.bytes);
  AtomicFile out(file);
  out.write(bytes);
  out.commit();
}

}  // namespace pliant
