#include "bench/runs/frames.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <fstream>
#include <optional>

#include "model/adaptive/sheet_refinement.hpp"
#include "model/garment.hpp"
#include "solver/base/atomic_file.hpp"

namespace drape::bench {
namespace {

namespace fs = std::filesystem;

/// A name for a run that any file system takes.
std::string run_name(const RunSpec& spec) {
  std::string name = fmt::format("{}-{}-{}", spec.scene.name, spec.method_name(), spec.step);
  std::ranges::replace_if(
      name, [](unsigned char c) { return !std::isalnum(c) && c != '.' && c != '_'; }, '-');
  return name;
}

void write(const fs::path& file, double t, const model::Polygons& polygons) {
  std::ofstream out(file);
  fmt::print(out, "# t = {:g} s\n", t);
  model::write_obj(out, polygons);
  out.close();
  if (!out) throw base::FileError(fmt::format("{}: cannot be written; choose another --frames", file.string()));
}

class Writer : public Observer {
 public:
  Writer(const RunSpec& spec, const Frames& frames)
      : folder_(frames.folder / run_name(spec)), every_(frames.every), trimmed_(model::trimmed_surface(spec.scene)) {
    base::create_folder(folder_);
    if (spec.scene.contact.adaptive) refinement_.emplace(model::Garment(spec.scene), spec.scene.obstacles);
    for (const model::ObstacleRule& rule : spec.scene.obstacles) obstacles_.emplace_back(rule, 4 * model::size(spec.scene));
  }

  void begin(const model::Scene&, const model::Cloth& cloth, const solver::State& start) override {
    cloth_ = &cloth;
    see(cloth.begin, start);
  }
  void observe(const solver::StepReport& step) override { see(step.t, step.y); }

 private:
  void see(double t, const solver::State& y) {
    const double periods = std::floor(t / every_ + 1e-9);  // times are sums of steps
    if (periods < due_) return;
    due_ = periods + 1;
    write(folder_ / fmt::format("sheet-{:04}.obj", frame_), t,
          trimmed_ ? trimmed_->at(cloth_->garment->spread(y.x)) : model::garment_polygons(*cloth_->garment, y.x));
    if (refinement_) write(folder_ / fmt::format("refined-{:04}.obj", frame_), t, refinement_->polygons(t, y.x));
    for (std::size_t k = 0; k < obstacles_.size(); ++k)
      write(folder_ / fmt::format("obstacle-{}-{:04}.obj", k, frame_), t, obstacles_[k].at(t));
    ++frame_;
  }

  fs::path folder_;
  double every_;
  const model::Cloth* cloth_ = nullptr;
  std::optional<model::TrimmedSurface> trimmed_;
  std::optional<model::SheetRefinement> refinement_;
  std::vector<model::PosedObstacle> obstacles_;
  double due_ = 0;
  int frame_ = 0;
};

}  // namespace

std::unique_ptr<Observer> frame_writer(const RunSpec& spec, const Frames& frames) {
  return std::make_unique<Writer>(spec, frames);
}

}  // namespace drape::bench
