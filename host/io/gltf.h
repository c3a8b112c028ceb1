// A moving surface as one binary glTF 2.0 file (.glb).
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace pliant {

/// Values at the vertices of a surface: values[i * components + c].
struct VertexArray {
  std::string name;
  int components = 1;  ///< 1 or 3
  std::vector<float> values;
};

/// The surface at one moment, with vertices split where normals differ. Frames of one `topology` have the same triangles.
struct SurfaceFrame {
  double time = 0;  ///< [s]
  std::uint64_t topology = 0;
  std::vector<float> positions;         ///< [3 * vertices] [m]
  std::vector<float> normals;           ///< [3 * vertices] unit length
  std::vector<std::int32_t> triangles;  ///< [3 * triangles] outward by the right-hand rule
  std::vector<std::uint8_t> cut;        ///< [triangles] not 0: made by a cut; empty: none
  std::vector<VertexArray> fields{};    ///< the same in every frame
  std::vector<float> texture{};         ///< [2 * vertices] coordinates u to the right, v up; empty: none
};

/// Frames in the order of time; triangles are kept once per topology.
class SurfaceAnimation {
 public:
  /// Throws Error (internal) when times do not ascend, or counts or fields do not fit those of the topology's first frame.
  void add(SurfaceFrame frame);
  [[nodiscard]] bool empty() const { return parts_.empty(); }

  struct Part {
    std::uint64_t topology = 0;
    std::vector<std::int32_t> triangles;
    std::vector<std::uint8_t> cut;
    std::vector<float> texture;
    std::vector<double> times;                           ///< [s]
    std::vector<std::vector<float>> positions, normals;  ///< per time [3 * vertices]
    std::vector<std::vector<VertexArray>> fields;        ///< per time
  };
  [[nodiscard]] const std::vector<Part>& parts() const { return parts_; }

 private:
  std::vector<Part> parts_;
};

/// One mesh per topology, one morph target per further frame, an animation of their weights (linear) from time 0; a mesh whose
/// topology is not present is scaled to nothing. Cut faces have a material of their own. A field `mises` is the attribute
/// _MISES: its values in the first frame, and in every morph target what is added to them. Texture coordinates are TEXCOORD_0,
/// which glTF counts from the upper edge. At most kMostFrames frames: of longer animations an even choice. Throws Error when
/// the file cannot be written or would exceed 4 GiB.
void write_glb(const std::filesystem::path& file, const SurfaceAnimation& animation);

inline constexpr std::size_t kMostFrames = 120;

}  // namespace pliant
