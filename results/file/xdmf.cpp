#include "results/file/xdmf.hpp"

#include <fmt/format.h>

#include <iterator>

#include "results/file/run_file.hpp"
#include "solver/base/atomic_file.hpp"
#include "solver/base/printable.hpp"

namespace drape::results {
namespace {

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : base::printable(text)) switch (c) {
      case '&': result += "&amp;"; break;
      case '<': result += "&lt;"; break;
      case '"': result += "&quot;"; break;
      default: result += c;
    }
  return result;
}

/// A dataset of the trajectory and how XDMF calls what is in it.
struct Numbers {
  const char* dataset;
  const char* number;  ///< type and precision
  int components;
};
constexpr Numbers positions{"x", R"(NumberType="Float" Precision="8")", 3};

struct Attribute {
  const char* name;
  const char* type;
  Numbers numbers;
};
constexpr Attribute attributes[] = {{"velocity", "Vector", {"v", positions.number, 3}},
                                    {"stretch", "Scalar", {"stretch", positions.number, 1}},
                                    {"constraint", "Scalar", {"constraint", R"(NumberType="Int" Precision="4")", 1}}};

class XdmfText {
 public:
  explicit XdmfText(std::string hdf5_name) : hdf5_name_(std::move(hdf5_name)) {}

  std::string file(std::span<const RunRecord> runs) {
    text_ = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<Xdmf Version=\"3.0\">\n<Domain>\n";
    for (std::size_t k = 0; k < runs.size(); ++k)
      if (runs[k].trajectory) series(runs[k], fmt::format("/runs/{}/trajectory/", run_name(k)));
    return text_ + "</Domain>\n</Xdmf>\n";
  }

 private:
  void series(const RunRecord& run, const std::string& group) {
    const std::string name =
        fmt::format("{} {} h = {:g} s{}{}", run.scene, run.method, run.step, run.overrides.empty() ? "" : " ", run.overrides);
    add(R"(<Grid Name="{}" GridType="Collection" CollectionType="Temporal">)", escaped(name));
    for (std::size_t k = 0; k < run.trajectory->times.size(); ++k) frame(*run.trajectory, group, k);
    add("</Grid>");
  }

  void frame(const TrajectoryRecord& trajectory, const std::string& group, std::size_t k) {
    const std::string time = fmt::format(R"(<Time Value="{}"/>)", trajectory.times[k]);
    if (trajectory.panels.empty()) return panel(trajectory, group, k, "sheet", time, 0, {trajectory.nu, trajectory.nv});
    add(R"(<Grid Name="garment" GridType="Collection" CollectionType="Spatial">{})", time);
    int first = 0;
    for (const std::array<int, 2>& n : trajectory.panels) {
      panel(trajectory, group, k, "panel", "", first, n);
      first += n[0] * n[1];
    }
    add("</Grid>");
  }

  void panel(const TrajectoryRecord& trajectory, const std::string& group, std::size_t k, const char* name,
             const std::string& time, int first, const std::array<int, 2>& n) {
    add(R"(<Grid Name="{}" GridType="Uniform">{})", name, time);
    add(R"(<Topology TopologyType="3DSMesh" Dimensions="1 {} {}"/>)", n[1], n[0]);
    add(R"(<Geometry GeometryType="XYZ">)");
    numbers(trajectory, group, positions, k, first, n[0] * n[1]);
    add("</Geometry>");
    for (const Attribute& shown : attributes) {
      add(R"(<Attribute Name="{}" AttributeType="{}" Center="Node">)", shown.name, shown.type);
      numbers(trajectory, group, shown.numbers, k, first, n[0] * n[1]);
      add("</Attribute>");
    }
    add("</Grid>");
  }

  /// Some rows of one frame of a dataset, chosen as `file:path|start:stride:count:shape`: the only way that ParaView's Xdmf3
  /// reader knows.
  void numbers(const TrajectoryRecord& trajectory, const std::string& group, const Numbers& what, std::size_t k, int first,
               int count) {
    const bool vector = what.components > 1;
    const auto rows = [&](int n) { return fmt::format("{}{}", n, vector ? " 3" : ""); };
    const char *zero = vector ? " 0" : "", *ones = vector ? "1 1 1" : "1 1";
    add(R"(<DataItem Format="HDF" {} Dimensions="1 {}">{}:{}{}|{} {}{}:{}:1 {}:{} {}</DataItem>)", what.number, rows(count),
        escaped(hdf5_name_), group, what.dataset, k, first, zero, ones, rows(count), trajectory.times.size(),
        rows(trajectory.nu * trajectory.nv));
  }

  template <class... Values>
  void add(fmt::format_string<Values...> form, Values&&... values) {
    fmt::format_to(std::back_inserter(text_), form, std::forward<Values>(values)...);
    text_ += '\n';
  }

  std::string hdf5_name_, text_;
};

}  // namespace

std::filesystem::path xdmf_path(const std::filesystem::path& hdf5_file) { return hdf5_file.string() + ".xdmf"; }

void write_xdmf(const std::filesystem::path& hdf5_file, std::span<const RunRecord> runs) {
  const std::string text = XdmfText(hdf5_file.filename()).file(runs);
  base::publish(xdmf_path(hdf5_file), std::as_bytes(std::span(text)), base::Existing::replace);
}

}  // namespace drape::results
