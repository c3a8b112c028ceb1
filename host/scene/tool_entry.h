// One tool by itself, as a host adds it to a scene that runs already.
#pragma once
#include <filesystem>
#include <string>

#include "pliant/tool.h"
#include "scene/scene.h"

namespace pliant {

/// A point of a surface keeps a bit for each tool that is near.
inline constexpr std::size_t most_tools = 30;

/// The tool of a struct, checked as scene_of() checks those of a scene. A name may be missing. Throws Error (input).
ContactTool tool_of(const ToolSpec& spec);
/// The tool of a text, an entry of the list "tools" of a scene file; relative paths start from `folder`. Throws Error (input).
ContactTool parse_tool(const std::string& text, const std::filesystem::path& folder);
/// Throws Error (input) for a tool that no scene file could have.
void check_tool(const ContactTool& tool);
/// Throws Error (input) for a scene whose integrator, relaxation, solver or models allow no contact.
void check_takes_tools(const Scene& scene);

}  // namespace pliant
