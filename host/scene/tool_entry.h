// A single tool that a host adds to a running scene.
#pragma once
#include <filesystem>
#include <string>

#include "pliant/tool.h"
#include "scene/scene.h"

namespace pliant {

/// Limit because each contact point stores one bit per nearby tool.
inline constexpr std::size_t most_tools = 29;

/// The tool of a struct, checked as scene_of() checks those of a scene. A name may be missing. Throws Error (input).
ContactTool tool_of(const ToolSpec& spec);
/// The tool of a text, an entry of the list "tools" of a scene file; relative paths start from `folder`. Throws Error (input).
ContactTool parse_tool(const std::string& text, const std::filesystem::path& folder);
/// Throws Error (input) for a tool that no scene file could have.
void check_tool(const ContactTool& tool);
/// Throws Error (input) for a scene whose integrator, relaxation, solver or models allow no contact.
void check_takes_tools(const Scene& scene);

}  // namespace pliant
