#pragma once

#include <string_view>

/// Files that are part of the program: those of this folder, and libraries as Debian's packages have them
/// (bench/CMakeLists.txt).
namespace drape::bench::embedded {

extern const std::string_view head_html, body_html, style_css;
extern const std::string_view plotly_js, three_js, orbit_controls_js;
extern const std::string_view data_js, tables_js, looks_js, plots_js, figures_js, run_figures_js, motion_js, player_js,
    report_js;

}  // namespace drape::bench::embedded
