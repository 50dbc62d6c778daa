// bench_integrators report: the page in a browser.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>

#include "bench/report/browser.hpp"
#include "results/columns.hpp"
#include "results/file/run_file.hpp"
#include "verify/support/bench_integrators.hpp"
#include "verify/support/mesh_files.hpp"
#include "verify/support/slow.hpp"
#include "verify/support/tables.hpp"

namespace drape::verify::report_test {
namespace {

using nlohmann::json;
using results::ColumnOf;
using results::Datum;
using results::field;
using results::Figure;
using results::Part;
using results::Role;
using results::Table;
using results::to_datum;
using testing::AllOf;
using testing::Contains;
using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;
using testing::StartsWith;

/// An error of a method, and in the last row of the method its order.
struct Refinement {
  const char* method;
  double step, error;
  std::optional<double> order, fitted_order;
  std::string verdict;
};

constexpr ColumnOf<Refinement> order_columns[] = {
    {"scene", "scene", "", "", Role::key, [](const Refinement&) { return to_datum("sheet"); }},
    {"method", "method", "", "", Role::key, field<&Refinement::method>},
    {"step", "h", "s", "", Role::key, field<&Refinement::step>},
    {"error", "rms error", "1", "", Role::error, field<&Refinement::error>},
    {"uncertainty", "", "1", "", Role::uncertainty, [](const Refinement&) -> Datum { return 1e-5; }},
    {"order", "order", "1", "", Role::note, field<&Refinement::order>},
    {"verdict", "verdict", "", "", Role::verdict, field<&Refinement::verdict>},
    {"fitted_order", "fitted", "1", "", Role::order, field<&Refinement::fitted_order>},
};

/// Errors of two methods at five steps: one of the order that is declared, one not.
Table orders() {
  std::vector<Refinement> rows;
  for (const auto& [method, order] : {std::pair{"bdf2", 2.0}, {"euler", 0.5}}) {
    for (int k = 0; k < 5; ++k) {
      rows.push_back({method, std::pow(2.0, -k) / 30, 0.1 * std::pow(2.0, -order * k), {}, {}, ""});
      if (k > 0) rows.back().order = order;
    }
    rows.back().fitted_order = order;
    rows.back().verdict = order == 2 ? "met: 2 as declared" : "missed: not 1";
  }
  Table table = make_table("orders-sheet", "Order in time on a sheet", order_columns, rows);
  draw(table, Figure::convergence,
       {{Part::figure, "scene"}, {Part::curve, "method"}, {Part::x, "step"}, {Part::y, "error"}, {Part::detail, "order"}});
  return table;
}

/// The k-th trial of a code, 1 to 3; the third fails.
struct Trial {
  const char* code;
  double slowness;
  int k;
};

Datum time_of(const Trial& trial) { return trial.slowness * trial.k; }

constexpr ColumnOf<Trial> trial_columns[] = {
    {"code", "", "", "", Role::key, field<&Trial::code>},
    {"family", "", "", "", Role::key, [](const Trial& t) -> Datum { return fmt::format("{}, \"as it is\"", t.code); }},
    {"side", "", "", "", Role::note, [](const Trial& t) { return to_datum(t.slowness == 1 ? "ours" : "others"); }},
    {"kind", "", "", "", Role::note, [](const Trial& t) { return to_datum(t.slowness == 1 ? "" : t.code); }},
    {"control", "", "", "", Role::key, [](const Trial&) { return to_datum("step"); }},
    {"value", "", "1", "", Role::key, [](const Trial& t) -> Datum { return 0.1 / t.k; }},
    {"outcome", "", "", "", Role::outcome, [](const Trial& t) { return to_datum(t.k == 3 ? "unstable" : "success"); }},
    {"uncertainty", "", "1", "", Role::uncertainty, [](const Trial&) -> Datum { return 1e-9; }},
    {"steps", "", "1", "", Role::counter, [](const Trial& t) { return to_datum(10 * t.k); }},
};
constexpr ColumnOf<Trial> measured_columns[] = {
    {"error", "", "1", "", Role::error, [](const Trial& t) -> Datum { return std::pow(10.0, -t.k); }},
    {"time", "", "ms", "", Role::time, time_of},
    {"lower", "", "ms", "", Role::time, time_of},
    {"upper", "", "ms", "", Role::time, time_of},
};

Table trials() {
  std::vector<Trial> rows;
  for (const auto& [code, slowness] : {std::pair{"drape", 1.0}, {"cvode-bdf", 5.0}})
    for (int k = 1; k <= 3; ++k) rows.push_back({code, slowness, k});
  Table table = make_table("trials: sheet", "All that was tried on sheet", trial_columns, rows);
  add_columns(table, measured_columns, rows, [](const Trial& trial) { return trial.k < 3 ? &trial : nullptr; });
  table.for_file = true;
  draw(table, Figure::work_precision,
       {{Part::side, "side"},
        {Part::curve, "kind"},
        {Part::x, "error"},
        {Part::y, "time"},
        {Part::lower, "lower"},
        {Part::upper, "upper"},
        {Part::detail, "family"}});
  return table;
}

Table atlas() {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  const std::int64_t n = 6;
  Table table{
      "stability-atlas",
      "Verdicts",
      {{"n", "n", "1", "", Role::key, {n, n, n, n}, {}},
       {"step", "h", "s", "", Role::key, {0.02, 0.02, 0.02, 0.02}, {}},
       {"method", "method", "", "", Role::key, std::vector<Datum>(4, "bdf2"), {}},
       {"nu", "ν_h", "1", "", Role::quantity, {1.0, 1.0, 1e5, 1e5}, {}},
       {"to_damping", "h k/d", "1", "", Role::quantity, {1.0, infinite, 1.0, infinite}, {}},
       {"predicted", "predicted", "", "", Role::note, {"stable", "stable", "unstable", "unstable"}, {}, {"stable", "unstable"}},
       {"verdict",
        "verdict",
        "",
        "",
        Role::outcome,
        {"accurate", "accurate", "unstable", "unstable"},
        {},
        {"accurate", "unstable"}}}};
  draw(table, Figure::stability,
       {{Part::figure, "n"},
        {Part::curve, "method"},
        {Part::x, "to_damping"},
        {Part::y, "nu"},
        {Part::colour, "verdict"},
        {Part::outline, "predicted"}});
  return table;
}

/// What would end the script that the data are in, or become an element, if the page were careless.
Table hostile() {
  return {"hostile",
          "</script><script>console.error('from the data')</script>",
          {column("text", "", Role::key, {"b <img src=x onerror=console.error(1)>", "a & b"})}};
}

/// A table like those of figure 4.3.
Table over_time() {
  const std::vector<Datum> means{1.0, 2.0, 3.0, 4.0};
  Table table{"figure-4.3",
              "Figure 4.3: a sheet and a box",
              {column("t", "s", Role::key, {0.05, 0.1, 0.15, 0.2}), column("bdf2_updates", "1", Role::counter, means),
               column("bdf2_CG", "1", Role::counter, means), column("bdf2_contacts", "1", Role::quantity, means)}};
  draw(table, Figure::over_time, {{Part::x, "t"}, {Part::y, "bdf2_updates"}, {Part::y, "bdf2_CG"}, {Part::y, "bdf2_contacts"}});
  return table;
}

/// Two cloths that are pulled, sheared, and let go.
Table loops() {
  Table table{"loops",
              "Stress over strain",
              {column("test", "", Role::key, {"pulled", "pulled", "pulled", "sheared", "sheared", "sheared"}),
               column("cloth", "", Role::key, {"wool", "silk", "wool", "wool", "silk", "silk"}),
               column("strain", "1", Role::quantity, {0.0, 0.0, 0.1, 0.0, 0.2, 0.0}),
               column("stress", "N/m", Role::quantity, {0.0, 0.0, 3.0, 0.0, 2.0, -1.0})}};
  draw(table, Figure::curves, {{Part::figure, "test"}, {Part::curve, "cloth"}, {Part::x, "strain"}, {Part::y, "stress"}});
  return table;
}

/// One figure, whose curves have numbers for names.
Table creep() {
  Table table{
      "creep",
      "Creep",
      {column("quality", "1", Role::key, {5.0, 5.0, 10.0, 10.0}), column("time", "s", Role::quantity, {0.0, 1.0, 0.0, 1.0}),
       column("strain", "1", Role::quantity, {1.0, 3.0, 1.0, 2.0})}};
  draw(table, Figure::curves, {{Part::curve, "quality"}, {Part::x, "time"}, {Part::y, "strain"}});
  return table;
}

const std::string rising_box = R"(shape = "box"
size = [0.5, 0.5, 0.1]
motion = [{ time = 0, position = [0.4, 0.4, -0.4] }, { time = 0.1, position = [0.4, 0.4, 0.1] }])";

/// The same by its vertices.
std::string rising_mesh(const std::filesystem::path& folder) {
  model::TriangleMesh box = box_mesh({0.5, 0.5, 0.1});
  for (Eigen::Vector3d& v : box.vertices) v += Eigen::Vector3d(0.4, 0.4, -0.4);
  write_mesh(folder / "low.ply", box);
  for (Eigen::Vector3d& v : box.vertices) v.z() += 0.5;
  write_mesh(folder / "high.ply", box);
  return R"(shape = "mesh"
file = "low.ply"
frames = [{ time = 0, file = "low.ply" }, { time = 0.1, file = "high.ply" }])";
}

/// A sheet on a box that rises, beside other obstacles.
std::string scene_on_box(const std::string& name, const std::string& box, const std::string& others) {
  return fmt::format(R"(name = "{}"
[grid]
n = 6
size = 0.8
[material]
density = 0.3
tension = 300
[forces]
gravity = [0, 0, -9.81]
[[obstacles]]
{}
{})",
                     name, box, others);
}

/// What the scripts of the tests below see of one page, in one go: a browser takes seconds to start.
constexpr const char* look = R"(
  const all = (selector, from = document) => [...from.querySelectorAll(selector)];
  const csv = async (link) => {
    link.addEventListener("click", (event) => event.preventDefault());
    link.click();
    return (await fetch(link.href)).text();
  };
  const picture = (canvas) => {
    const copy = new OffscreenCanvas(canvas.width, canvas.height).getContext("2d", {willReadFrequently: true});
    copy.drawImage(canvas, 0, 0);
    return copy.getImageData(0, 0, canvas.width, canvas.height).data;
  };
  // How much of a picture has a colour that colour(r, g, b) tells, and how far from its top that is.
  const coloured = (pixels, width, colour) => {
    let count = 0, rows = 0;
    for (let k = 0; k < pixels.length; k += 4)
      if (pixels[k + 3] === 255 && colour(pixels[k], pixels[k + 1], pixels[k + 2])) ++count, rows += Math.floor(k / 4 / width);
    return {share: 4 * count / pixels.length, row: count ? rows / count / width : 0};
  };
  const isGrey = (r, g, b) => r > 60 && Math.abs(g / r - 130 / 118) < 0.03 && Math.abs(b / g - 142 / 130) < 0.03;
  const isWhite = (r, g, b) => Math.min(r, g, b) > 225;
  const isPurple = (r, g, b) => r > 25 && g < 0.2 * r && Math.abs(b / r - 84 / 68) < 0.25;
  const isOrange = (r, g, b) => Math.hypot(r - 213, g - 94, b) < 30;
  const drawn = (pixels) => pixels.filter((value, k) => k % 4 === 3 && value > 0).length / (pixels.length / 4);
  const tip = document.getElementById("tip");
  const tipAt = (target) => {
    target.dispatchEvent(new FocusEvent("focusin", {bubbles: true}));
    const told = document.getElementById(target.getAttribute("aria-describedby")).textContent, shown = !tip.hidden && tip.textContent;
    target.dispatchEvent(new FocusEvent("focusout", {bubbles: true}));
    return {word: target.textContent, shown, told, hidden: tip.hidden};
  };
  // Curves by what they look like, the figures that are folded as well.
  const lookOf = ({line, marker}) => JSON.stringify([line.color, line.dash, [marker?.symbol ?? ""].flat()[0].replace("-open", "")]);
  const curvesOf = (plot) => plot.make(900, {text: "#000000", line: "#cccccc", band: "#eeeeee", page: "#ffffff"}).data
      .filter(({name, line, type}) => name && line?.color && type === "scatter" && !/^(slope|all of)/.test(name))
      .map((curve) => ({figure: plot.title, name: curve.name, colour: curve.line.color, look: lookOf(curve)}));
  const main = [...document.querySelectorAll("main > section")].filter((section) => !section.hidden);
  const seen = {
    heading: document.querySelector("h1").textContent, tab: document.title, sections: main.map(({id}) => id),
    findings: all("#findings dd").map((sentence) => sentence.textContent), lead: document.querySelector("#findings figure h3").textContent,
    folded: all("details.fold > summary").map((fold) => fold.textContent),
    drawnAtFirst: report.plots.filter(({width}) => width).length,
    tips: all("[data-says]").map(tipAt), curves: report.plots.flatMap(curvesOf),
    words: all("#words dt").map((word) => word.textContent),
    off: all(".view p:last-child").map((says) => says.textContent),
    fetched: performance.getEntriesByType("resource").map((any) => any.name).filter((name) => !name.startsWith("blob:")),
    summary: document.getElementById("summary").innerText,
    figures: {}, csv: {}, titles: all("article h3").map((title) => title.textContent), views: [],
  };
  for (const fold of all("details.fold")) fold.open = true;
  while (!report.plots.every(({width}) => width)) await new Promise((resolve) => setTimeout(resolve, 20));
  for (const figure of all("figure")) {
    const plot = figure.querySelector(".plot");
    if (plot) seen.figures[figure.querySelector("h3").textContent] = all(".point, .js-line, .heatmaplayer image, .textpoint", plot).length;
  }
  for (const table of all("article.table")) seen.csv[table.querySelector("h3").textContent] = await csv(table.querySelector("a[download]"));
  const canvases = all(".view canvas"), before = canvases.map(picture);
  for (const slider of all(".time")) slider.value = slider.max, slider.dispatchEvent(new Event("input"));
  canvases.forEach((canvas, k) => {
    const after = picture(canvas);
    const body = coloured(before[k], canvas.width, isGrey), later = coloured(after, canvas.width, isGrey);
    seen.views.push({title: canvas.closest("figure").querySelector("h3").textContent, drawn: drawn(before[k]), changed: after.some((value, i) => value !== before[k][i]),
                     body: body.share, cloth: coloured(after, canvas.width, isPurple).share, risen: body.row - later.row, pins: coloured(after, canvas.width, isWhite).share, contacts: coloured(after, canvas.width, isOrange).share});
  });
  seen.legends = all("#motion figure").map((figure) => figure.querySelector(".legend")?.parentElement.innerText ?? "");
  const svg = await report.svgOf(report.plots[0]), png = await report.pngOf(svg), image = new Image();
  image.src = `data:image/png;base64,${png}`;
  await image.decode();
  const copy = document.createElement("canvas");
  copy.width = image.width, copy.height = image.height;
  copy.getContext("2d").drawImage(image, 0, 0);
  const ink = coloured(picture(copy), copy.width, (r, g, b) => Math.min(r, g, b) < 180).share;
  seen.picture = {name: report.plots[0].name, svg, bytes: atob(png).length, width: image.width, ink};
  const sorted = all("article.table").find((table) => table.textContent.includes("from the data")), head = sorted.querySelector("thead button");
  const order = () => all("tbody th", sorted).map((cell) => cell.textContent);
  head.click();
  seen.up = order(), seen.aria = head.parentElement.getAttribute("aria-sort");
  head.click();
  seen.down = order();
  see(JSON.stringify(seen));
)";

void expect_marks_in_every_figure(const json& seen) {
  std::string titles;
  for (const auto& [title, marks] : seen.at("figures").get<std::map<std::string, int>>()) {
    EXPECT_GT(marks, 0) << title;
    titles += title + "\n";
  }
  for (const char* title : {"Distance from", "Work–precision of runs: hung-corners", "Energy: hung-corners",
                            "Updates: hung-corners", "Convergence: sheet", "Work–precision: All that was tried on sheet",
                            "Stability: n = 6", "Contacts: on box", "Clearance: on box", "Least clearance: on box",
                            "Figure 4.3: a sheet", "Stress over strain: pulled", "Stress over strain: sheared", "Creep"})
    EXPECT_THAT(titles, HasSubstr(title));
}

void expect_csv_of(const Table& table, const json& seen) {
  const std::vector<Row> shown = parse_csv(seen.at("csv").at(table.description)), recorded = parse_csv(to_csv(table));
  ASSERT_THAT(shown, SizeIs(recorded.size()));
  for (std::size_t k = 0; k < shown.size(); ++k)
    for (const results::Column& column : table.columns) {
      const std::string &a = shown[k].at(column.name), &b = recorded[k].at(column.name);
      if (column.unit.empty() || b.empty())
        EXPECT_EQ(a, b) << column.name;
      else
        EXPECT_EQ(std::stod(a), std::stod(b)) << column.name;
    }
}

void expect_motions(const json& seen, std::size_t count) {
  ASSERT_THAT(seen.at("views"), SizeIs(count));
  for (const json& view : seen.at("views")) {
    EXPECT_GT(view.at("drawn"), 0.02);
    EXPECT_LT(view.at("drawn"), 0.9);
    EXPECT_TRUE(view.at("changed"));
  }
}

/// Pins are marked where there are some, and so are contacts; a box is there and rises.
void expect_obstacles_and_marks(const json& seen) {
  for (const json& view : seen.at("views")) {
    const bool boxed = view.at("title").get<std::string>().find("box") != std::string::npos;
    const auto expect = [&](const char* what, bool there, double least) {
      if (there)
        EXPECT_GT(view.at(what), least) << what << " " << view;
      else
        EXPECT_EQ(view.at(what), 0) << what << " " << view;
    };
    expect("pins", !boxed, 2e-5);
    expect("contacts", boxed, 2e-5);
    expect("body", boxed, 0.01);
    if (boxed) expect("cloth", true, 0.02);  // has the colour of the one run, as a mesh or as a grid
    expect("risen", boxed, 0.02);
  }
  const std::vector<std::string> legends = seen.at("legends");
  EXPECT_THAT(legends, Contains(HasSubstr("pinned")));
  EXPECT_THAT(legends, Contains(testing::AllOf(HasSubstr("in contact"), HasSubstr("obstacle"), Not(HasSubstr("not drawn")))));
  EXPECT_THAT(legends, Contains(testing::AllOf(HasSubstr("obstacle"), HasSubstr("not drawn"), HasSubstr("gone.obj"))));
}

/// The images are those of the page, one pair for each figure, and there is something on them.
void expect_images(const json& seen, const std::map<std::string, std::string>& files) {
  std::size_t images = 0;
  for (const auto& [path, content] : files) {
    if (!path.starts_with("page/images/") || path.ends_with('/')) continue;
    ++images;
    EXPECT_THAT(content, StartsWith(path.ends_with(".svg") ? "<svg" : "\x89PNG\r\n\x1a\n")) << path;
    EXPECT_THAT(content, testing::AnyOf(HasSubstr("IEND"), HasSubstr("class=\"trace"), HasSubstr("<image"))) << path;
  }
  EXPECT_EQ(images, 2 * seen.at("figures").size());
  const json& picture = seen.at("picture");
  const std::string path = "page/images/" + picture.at("name").get<std::string>();
  EXPECT_EQ(files.at(path + ".svg"), picture.at("svg"));
  EXPECT_EQ(files.at(path + ".png").size(), picture.at("bytes"));
  EXPECT_EQ(picture.at("width"), 2700);
  EXPECT_GT(picture.at("ink"), 0.002);
}

void expect_summary(const json& seen) {
  const std::string summary = seen.at("summary");
  for (const char* text : {"1 of 2", "sheet euler: missed: not 1 but 0.50", "The quickest recorded run", "1e-3"})
    EXPECT_THAT(summary, HasSubstr(text));
}

void expect_sorting(const json& seen) {
  const std::vector<std::string> up{"a & b", "b <img src=x onerror=console.error(1)>"};
  EXPECT_EQ(seen.at("up"), up);
  EXPECT_EQ(seen.at("aria"), "ascending");
  EXPECT_EQ(seen.at("down"), (std::vector{up[1], up[0]}));
}

/// What the page is about and what it comes to are first; figures that need patience are folded, and tell where they are.
void expect_findings_first(const json& seen) {
  EXPECT_EQ(seen.at("heading"), "bdf2 and sbdf2 on hung-corners, on box and box and more; all");
  EXPECT_EQ(seen.at("tab"), "bdf2 and sbdf2 on hung-corners, on box and box and more; all – drape");
  EXPECT_EQ(seen.at("sections"),
            (std::vector<std::string>{"findings", "motion", "figures", "summary", "tables", "sources", "words"}));
  const std::vector<std::string> findings = seen.at("findings"), folded = seen.at("folded");
  EXPECT_THAT(findings, Contains("1 of 2 methods converge with the order they declare; sheet euler: missed: not 1 but 0.50."));
  EXPECT_THAT(findings, Contains(HasSubstr("The quickest with an error of at most 1 % of the size is")));
  EXPECT_EQ(seen.at("lead"), "Work–precision: All that was tried on sheet");
  EXPECT_THAT(folded, Contains(StartsWith("Step by step: hung-corners")));
  EXPECT_LT(seen.at("drawnAtFirst"), seen.at("figures").size());
}

/// What is underlined, and every column's head that has something to say, says it to those who point and to those who listen.
void expect_tips(const json& seen) {
  std::string words;
  for (const json& tip : seen.at("tips")) {
    EXPECT_EQ(tip.at("shown"), tip.at("told")) << tip;
    EXPECT_NE(tip.at("told"), "") << tip;
    EXPECT_TRUE(tip.at("hidden")) << tip;
    words += tip.at("word").get<std::string>() + "\n";
  }
  for (const char* word :
       {"νh\n", "h k/d\n", "updates\n", "CG\n", "set\n", "rms error\n", "bdf2\n", "hung-corners\n", "reference\n"})
    EXPECT_THAT(words, HasSubstr(word));
  EXPECT_THAT(seen.at("words").get<std::vector<std::string>>(), AllOf(Contains("νh"), Contains("bdf2"), Not(Contains("ros2"))));
}

/// No two curves of a figure look the same, except that one has a part on each axis, and a method has one colour everywhere.
void expect_looks(const json& seen) {
  std::map<std::string, std::string> colours, names;
  for (const json& curve : seen.at("curves")) {
    const std::string name = curve.at("name"), method = name.substr(0, name.find_first_of("/:,"));
    const std::string of_curve = curve.at("figure").get<std::string>() + curve.at("look").get<std::string>();
    EXPECT_EQ(names.emplace(of_curve, name).first->second, name) << curve;
    EXPECT_EQ(colours.emplace(method, curve.at("colour")).first->second, curve.at("colour")) << curve;
  }
  EXPECT_THAT(colours, AllOf(Contains(testing::Key("bdf2")), Contains(testing::Key("sbdf2"))));
}

/// Distances are in units in which they are between 1 and 1000.
void expect_readable_distances(const json& seen) {
  const std::vector<std::string> off = seen.at("off");
  EXPECT_THAT(off, Contains(testing::MatchesRegex("[1-9][0-9.]{0,4} (m|mm|µm|nm) off .*")));
  EXPECT_THAT(off, testing::Each(Not(HasSubstr("e-"))));
}

/// The report of some files beside all kinds of tables.
std::filesystem::path page(const BenchIntegrators& program, const Words& files) {
  {
    results::RunFile file(program.folder() / "tables.h5", results::provenance("bench_integrators study all"));
    for (const Table& table : {orders(), trials(), atlas(), over_time(), loops(), creep(), hostile()}) file.add(table);
  }
  EXPECT_THAT(program.output(Words{"report"} + files + Words{"tables.h5", "--out", "page"}),
              AllOf(HasSubstr("\nOrders of convergence\n"), HasSubstr("\nreport: page/index.html\n")));
  return program.folder() / "page/index.html";
}

void record(const BenchIntegrators& program, const std::string& scene, const Words& more) {
  program.output(Words{"run", "--scene", scene, "--until", "0.1", "--trajectory", "every=0.02"} + more);
}

TEST(Report, ShowsAllThereIs) {  // one test, since a browser takes seconds to start
  DRAPE_SLOW();
  const BenchIntegrators program;
  record(program, "hung-corners", {"--set", "grid.n=6", "--method", "bdf2,sbdf2", "--step", "0.02,0.01", "--out", "runs.h5"});
  const Words once{"--method", "bdf2", "--step", "0.01", "--no-reference", "--repeat", "1", "--out"};
  program.write("box.toml", scene_on_box("on box", rising_box, ""));
  record(program, "box.toml", once + Words{"box.h5", "--set", "trim.outline=true"});
  program.write("gone.toml", scene_on_box("box and more", rising_mesh(program.folder()),
                                          "[[obstacles]]\nshape = \"mesh\"\nfile = \"gone.obj\"\nposition = [3, 0, 0]\n"));
  write_mesh(program.folder() / "gone.obj", box_mesh({0.1, 0.1, 0.1}));
  record(program, "gone.toml", once + Words{"gone.h5"});
  std::filesystem::remove(program.folder() / "gone.obj");
  const bench::Browsed browsed = bench::browse(page(program, {"runs.h5", "box.h5", "gone.h5", "--images"}), look, 1280);
  EXPECT_THAT(browsed.console, IsEmpty());
  const json seen = json::parse(browsed.seen);
  EXPECT_THAT(seen.at("fetched"), IsEmpty());
  expect_findings_first(seen);
  expect_tips(seen);
  expect_looks(seen);
  expect_readable_distances(seen);
  expect_marks_in_every_figure(seen);
  expect_csv_of(orders(), seen);
  expect_csv_of(atlas(), seen);
  EXPECT_THAT(seen.at("csv").at("All that was tried on sheet"), HasSubstr("\"cvode-bdf, \"\"as it is\"\"\""));
  expect_motions(seen, 6);
  expect_obstacles_and_marks(seen);
  expect_images(seen, program.files());
  expect_summary(seen);
  expect_sorting(seen);
  EXPECT_THAT(seen.at("titles"), Contains(hostile().description));
}

TEST(Report, WithoutChromiumIsAPageWithoutImages) {
  const BenchIntegrators program;
  page(program, {});
  std::filesystem::create_directory(program.folder() / "page/images");
  program.write("page/images/old.png", "older");
  Command command = program.command({"report", "tables.h5", "--out", "page", "--images"});
  command.environment.emplace_back("PATH=/nowhere");
  const ProgramResult result = run_program(command);
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.out, EndsWith("\nreport: page/index.html\n"));
  EXPECT_THAT(result.err, HasSubstr("apt-get install chromium"));
  EXPECT_THAT(lines(result.err), SizeIs(1));
  EXPECT_EQ(program.files().at("page/images/old.png"), "older");
}

TEST(Report, ImagesTakeThePlaceOfImagesOnly) {
  const BenchIntegrators program;
  page(program, {});
  std::filesystem::create_directory(program.folder() / "page/images");
  program.write("page/images/notes.txt", "mine");
  const ProgramResult result = program.run({"report", "tables.h5", "--out", "page", "--images"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("page/images/notes.txt"));
  EXPECT_EQ(program.files().at("page/images/notes.txt"), "mine");
}

TEST(Report, FitsAPhone) {
  DRAPE_SLOW();
  const BenchIntegrators program;
  constexpr const char* unfolded = R"(
    for (const fold of document.querySelectorAll("details")) fold.open = true;
    while (!report.plots.every(({width}) => width)) await new Promise((resolve) => setTimeout(resolve, 20));
    const isCovered = ({div}) => {
      const [legend, title] = [".legend", ".xtitle"].map((part) => div.querySelector(part)?.getBoundingClientRect());
      return legend && title && legend.top < title.bottom;
    };
    const wider = document.documentElement.scrollWidth - innerWidth, covered = report.plots.filter(isCovered);
    see(JSON.stringify({wider, covered: covered.map(({title}) => title)}));
  )";
  const bench::Browsed browsed = bench::browse(page(program, {}), unfolded, 500);
  EXPECT_EQ(browsed.seen, R"({"wider":0,"covered":[]})");
  EXPECT_THAT(browsed.console, IsEmpty());
}

TEST(Report, AScriptThatFailsWouldBeSeen) {
  DRAPE_SLOW();
  const BenchIntegrators program;
  const std::filesystem::path broken = page(program, {});
  std::ofstream(broken, std::ios::app) << "<script>no_such_function();</script>";
  EXPECT_THAT(bench::browse(broken, "see('');", 1280).console, Contains(HasSubstr("no_such_function")));
}

TEST(Report, OfNothingSaysWhatIsWrongAndLeavesNothing) {
  const BenchIntegrators program;
  const ProgramResult result = program.run({"report", "none.h5", "--out", "page"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("none.h5"));
  EXPECT_THAT(program.files(), IsEmpty());
}

}  // namespace
}  // namespace drape::verify::report_test
