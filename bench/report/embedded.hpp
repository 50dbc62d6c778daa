#pragma once

#include <string_view>

/// Files that are part of the program: those of this folder, and libraries as Debian's packages have them
/// (bench/CMakeLists.txt).
namespace drape::bench::embedded {

extern const std::string_view head_html, body_html, style_css;
extern const std::string_view plotly_js, three_js, orbit_controls_js;
extern const std::string_view report_js;  ///< all modules of this folder in one script

}  // namespace drape::bench::embedded
