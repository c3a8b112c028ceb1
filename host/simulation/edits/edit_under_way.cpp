#include "simulation/edits/edit_under_way.h"

#include <chrono>
#include <utility>

namespace pliant {

EditUnderWay::EditUnderWay(RunContext& run, HostLoads& loads, EditedBodies& bodies, ModelEdit edit, const CutReport& report)
    : edit_(std::move(edit)), report_(report), swap_(run, loads, bodies, report_), scene_(edit_.scene()) {
  if (edit_.keeps_bodies) swap_.keep_bodies();
}

EditUnderWay::~EditUnderWay() { wait(); }

void EditUnderWay::build() {
  Stopwatch clock;
  std::vector<NodeOrigins> origins = edit_.edit(report_);
  report_.topology += clock.lap();
  if (report_.changed) swap_.build(scene_, std::move(origins), edit_.ready);
}

void EditUnderWay::build_beside(HelperThread& builder) {
  building_ = builder.run([this] {
    build();
    swap_.compile();
    swap_.take_surfaces();
  });
}

void EditUnderWay::wait() const {
  if (building_.valid()) building_.wait();
}

bool EditUnderWay::built() const {
  return !building_.valid() || building_.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

void EditUnderWay::load(std::vector<double> u) {
  try {
    if (building_.valid()) building_.get();
    if (report_.changed && !swap_.fits()) {  // tools or ballast have changed meanwhile
      swap_.renew();
      swap_.build(edit_.scene(), std::vector<NodeOrigins>(swap_.origins()), [] {});
    }
    if (report_.changed) swap_.load(std::move(u));
  } catch (...) {
    give_up();
    throw;
  }
  edit_.record(swap_, report_);
}

void EditUnderWay::give_up() {
  wait();
  building_ = {};
  edit_.undo();
  also_undo_();
}

}  // namespace pliant
