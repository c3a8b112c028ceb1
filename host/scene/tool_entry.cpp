#include "scene/tool_entry.h"

#include <fmt/format.h>

#include "pliant/error.h"
#include "scene/json_text.h"
#include "scene/parts.h"

namespace pliant {
namespace {

std::string shown_name(const std::string& name) { return name.empty() ? "tool" : fmt::format("tool \"{}\"", name); }

template <class T>
ContactTool written_and_read(const T& tool) {
  const std::string shown = shown_name(tool.name);
  const nlohmann::json entry = tool_json(tool, {});
  return read_contact_tool(Reader(entry, shown, ""), "", {});
}

}  // namespace

ContactTool parse_tool(const std::string& text, const std::filesystem::path& folder) {
  const std::string shown = "tool";
  const nlohmann::json document = parse_json(text, shown);
  return read_contact_tool(Reader(document, shown, ""), "", folder);
}

ContactTool tool_of(const ToolSpec& spec) { return written_and_read(spec); }

void check_tool(const ContactTool& tool) { (void)written_and_read(tool); }

void check_takes_tools(const Scene& scene) {
  const auto refuse = [](const std::string& has) {
    throw Error(ErrorCode::bad_input, fmt::format("a scene with {} takes no tools (docs/scene.md, tools)", has));
  };
  const IntegratorInfo& integrator = integrator_info(scene.integrator);
  if (!integrator.contact) refuse(fmt::format("\"integrator\": \"{}\"", integrator.word));
  if (scene.relaxation.enabled) refuse("relaxation");
  if (scene.solver.enabled) refuse("a static solver");
  for (const Body& body : scene.bodies) {
    if (body.model.substeps > 1) refuse(fmt::format("substeps of shape matching (body \"{}\")", body.name));
  }
}

}  // namespace pliant
