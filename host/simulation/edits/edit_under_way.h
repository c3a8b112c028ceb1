// An edit in parts, the longest of which can work beside steps. Private to host/simulation.
#pragma once
#include <functional>
#include <future>
#include <memory>
#include <utility>
#include <vector>

#include "scene/scene.h"
#include "simulation/edits/model_swap.h"

namespace pliant {

/// What makes an edit. All but `edit` and `ready` run on the stepping thread.
struct ModelEdit {
  std::function<Scene()> scene;  ///< of the new model
  /// Edits the bodies and sets CutReport::changed. Returns the origins of their nodes.
  std::function<std::vector<NodeOrigins>(CutReport&)> edit;
  std::function<void()> ready = [] {};                       ///< waits for the surfaces of the bodies
  std::function<void(const ModelSwap&, CutReport&)> record;  ///< once the new model is loaded, or nothing has changed
  std::function<void()> undo = [] {};                        ///< after an error: the bodies are as they were
  bool keeps_bodies = false;                                 ///< ModelSwap::keep_bodies()
};

/// One ModelEdit at work: build() or build_beside(), then load().
class EditUnderWay {
 public:
  EditUnderWay(RunContext& run, HostLoads& loads, EditedBodies& bodies, ModelEdit edit, const CutReport& report);
  EditUnderWay(const EditUnderWay&) = delete;
  EditUnderWay& operator=(const EditUnderWay&) = delete;
  /// Waits for the thread that builds.
  ~EditUnderWay();

  void build();
  /// The same on another thread. Nothing may change the bodies or the parameters of the scene until load() or give_up().
  void build_beside(HelperThread& builder);
  /// Returns true if load() does not have to wait.
  [[nodiscard]] bool built() const;
  void wait() const;
  /// Replaces the model of the run, which may have changed since build(). `u`: RunContext::u(). Throws what build() has thrown,
  /// too; then nothing has changed.
  void load(std::vector<double> u);
  /// Takes the edit back.
  void give_up();
  /// Call on the stepping thread: `undo` comes after that of the edit.
  void also_undo(std::function<void()> undo) { also_undo_ = std::move(undo); }
  [[nodiscard]] const CutReport& report() const { return report_; }

 private:
  ModelEdit edit_;
  CutReport report_;
  ModelSwap swap_;
  Scene scene_;
  std::function<void()> also_undo_ = [] {};
  std::future<void> building_;
};

}  // namespace pliant
