// Adds, removes and moves tools of a running simulation. Each call first checks the tool against the current position of the
// tissue; a rejected call changes nothing.
#pragma once
#include <string>

#include "simulation/contact/tool_contact.h"
#include "simulation/state/run_context.h"

namespace pliant {

class PresentTissue;

class ToolEdits {
 public:
  ToolEdits(RunContext& run, ToolContact& contact) : run_(run), contact_(contact) {}

  // Call these between two batches. They throw Error: usage for an unknown or duplicate name, an invalid pose or time;
  // bad_input for a tool that would start inside a body or has one in its way, a scene that allows no tools, or too many
  // tools.

  /// `form`: tool_form(tool).
  void add(const ContactTool& tool, const ToolForm& form);
  void remove(const std::string& name);
  /// Disables a tool, which stays known. Does nothing if it is parked.
  void park(const std::string& name);
  /// Enables a parked tool at its current pose. Does nothing if it is not parked.
  void unpark(const std::string& name);
  /// Moves a tool at once to a pose, where it stays. Unparks it.
  void place(const std::string& name, const Pose& at);
  /// Gives a tool a surface to come: the last of `next` (next_surface()). Throws Error (usage) for a tool whose shape cannot
  /// change, and if too many are to come.
  void set_surface(const std::string& name, const GivenSurfaces& next);
  /// Tells a tool to hold tissue, or to let it go. Throws Error (usage) for one without a grip.
  void grip(const std::string& name, bool on);
  /// Moves a tool from its current pose to another within `seconds` [s]. Unparks it. Throws Error (bad_input) if it is too
  /// fast and tissue is in its way.
  void drive(const std::string& name, const Pose& to, double seconds);
  /// Returns true if drive() looks whether the way is free: the tool is too fast for contact.
  [[nodiscard]] bool is_fast(const std::string& name, const Pose& to, double seconds) const;
  /// Of a tool of the model: `to`, or if drive() would refuse that, how far it may go on the straight way there.
  [[nodiscard]] Pose within_reach(const std::string& name, const Pose& to, double seconds) const;

  /// A tool of the scene or of the host, also a parked one. Throws Error (usage) for an unknown name.
  [[nodiscard]] const ContactTool& known(const std::string& name) const;

 private:
  struct Next;
  [[nodiscard]] Next with(ToolChanges changes, const ContactTool* fresh = nullptr, const ToolForm* form = nullptr) const;
  void take_up(Next next);
  [[nodiscard]] Next unparked(const std::string& name) const;
  [[nodiscard]] std::size_t number(const std::string& name) const;

  RunContext& run_;
  ToolContact& contact_;
};

}  // namespace pliant
