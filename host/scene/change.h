// Changes of a scene's parameters while it runs: gravity, materials, models, and supports. Key "changes" of a scene file,
// and the calls World::change(), set_gravity(), ... of a host.
#pragma once
#include <string>

namespace pliant {

struct Scene;

/// An entry of "changes".
struct SceneChange {
  double time = 0;      ///< [s]
  std::string text;     ///< JSON text of the entry without its time
  std::string pointer;  ///< JSON pointer ("/changes/0")
};

/// Parameters are JSON text: the gravity, materials, models and lists of held nodes that differ from those of the scene,
/// complete. Empty: none. They belong to the scene as it was loaded.
///
/// Returns the scene with these parameters. Throws Error (bad_input) if they do not belong to it.
Scene with_parameters(const Scene& scene, const std::string& parameters);

/// Returns the parameters after a change. `change`: JSON text, an entry of "changes" without its time. `where` is what messages
/// call it. Throws Error (bad_input) with the JSON pointer, the value and the allowed values.
std::string changed_parameters(const Scene& scene, const std::string& parameters, const std::string& change,
                               const std::string& where);

/// Returns true if two parameters differ in gravity alone, or not at all.
bool differ_in_gravity_alone(const std::string& a, const std::string& b);

/// Throws Error (bad_input) for a scene whose solver or integrator allows no change.
void check_takes_changes(const Scene& scene);

}  // namespace pliant
