// Tools that come and go while a simulation runs, and where the host puts them. Each call checks what it may meet in the tissue
// as it is now; what it refuses changes nothing.
#pragma once
#include <string>

#include "simulation/contact/tool_contact.h"
#include "simulation/state/run_context.h"

namespace pliant {

class PresentTissue;

class ToolEdits {
 public:
  ToolEdits(RunContext& run, ToolContact& contact) : run_(run), contact_(contact) {}

  // All are to be called between two batches. They throw Error: usage for a name that no tool has or another one has already,
  // for a pose or a time that is none, bad_input for a tool that would begin inside a body or has one in its way, a scene that
  // takes no tools, or more of them than there may be.

  /// `form`: tool_form(tool).
  void add(const ContactTool& tool, const ToolForm& form);
  void remove(const std::string& name);
  /// It stays known, and touches nothing. Nothing if it is parked.
  void park(const std::string& name);
  /// Where it is now. Nothing if it is not parked.
  void unpark(const std::string& name);
  /// Put a tool somewhere at once, where it stays. One that was parked is so no more.
  void place(const std::string& name, const Pose& at);
  /// From where it is now to a pose, which it has after `seconds`. One that was parked is so no more.
  void drive(const std::string& name, const Pose& to, double seconds);

 private:
  struct Next;
  [[nodiscard]] const ContactTool& known(const std::string& name) const;
  [[nodiscard]] Next with(ToolChanges changes, const ContactTool* fresh = nullptr, const ToolForm* form = nullptr) const;
  void take_up(Next next);
  [[nodiscard]] Next unparked(const std::string& name) const;
  [[nodiscard]] std::size_t number(const std::string& name) const;

  RunContext& run_;
  ToolContact& contact_;
};

}  // namespace pliant
