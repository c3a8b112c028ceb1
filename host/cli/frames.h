// The files of a run: one frame after another, and the series that ParaView opens.
#pragma once
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "cli/frame_fields.h"
#include "io/folder_lock.h"
#include "io/gltf.h"
#include "io/vtu.h"
#include "render/export.h"
#include "render/picture.h"
#include "scene/keys.h"
#include "simulation/simulation.h"

namespace pliant::cli {

enum class OutputFormat { vtu, obj, png, gltf };
const Words<OutputFormat>& format_words();
/// Those that this build can write.
Words<OutputFormat> available_formats();

/// Words of --format, checked. Throws Error that lists the formats there are, or says why this build has no pictures.
std::set<OutputFormat> parse_formats(const std::vector<std::string>& formats);

/// All bodies as volume elements in their present shape: displacement [m], velocity [m/s] at the points, body and fill at the
/// cells; in a scene with blades also cut (1: a copy of a cell that a blade has divided) and piece (elements that hold together
/// have one number, counted from 0 in each body).
VtuMesh volume_frame(const Simulation& simulation);

/// The embedded surface in its present shape: displacement [m] at the points, body at the cells; in a scene with blades also
/// cut (1: a face that a blade made).
VtuMesh surface_frame(Simulation& simulation);

/// The surface as an OBJ file, with the texture coordinates of the scene's surfaces and with normals if they have any.
void write_surface_obj(const std::filesystem::path& file, const Model& model, const std::vector<Vec3d>& positions);

class FrameWriter {
 public:
  /// Makes the folder where it is missing, locks it (FolderLock) and tries it. Throws Error when nothing can be written there,
  /// or another run writes there.
  FrameWriter(std::filesystem::path folder, std::string stem, std::set<OutputFormat> formats, std::vector<FrameField> fields,
              const render::PictureOptions& pictures);

  /// Write the present state. Files carry the number of the step: bunny_00000100.vtu, bunny_surface_00000100.vtu and .obj,
  /// listed in bunny.pvd and bunny_surface.pvd; bunny_00000100.png.
  void write(Simulation& simulation);
  /// Files that can only be written at the end: bunny.glb, all frames in one animation.
  void finish();
  [[nodiscard]] std::size_t frames() const { return frames_; }
  /// Files of frames of this stem and these formats that were there before.
  [[nodiscard]] std::size_t older() const { return older_; }
  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }

 private:
  std::filesystem::path folder_;
  std::optional<FolderLock> lock_;
  std::string stem_;
  std::set<OutputFormat> formats_;
  std::vector<FrameField> fields_;
  PvdSeries volume_, surface_;
  std::optional<render::Pictures> pictures_;
  SurfaceAnimation animation_;
  render::FrameSplitter splitter_;
  std::optional<std::int64_t> last_step_;
  std::size_t frames_ = 0, older_ = 0;
};

}  // namespace pliant::cli
