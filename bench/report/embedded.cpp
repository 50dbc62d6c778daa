#include "bench/report/embedded.hpp"

/// The assembler copies the file into the program as it is.
#define DRAPE_EMBED(name, file)                                                                \
  asm(".section .rodata\n.global drape_" #name "_begin, drape_" #name                          \
      "_end\n"                                                                                 \
      "drape_" #name "_begin:\n.incbin \"" file "\"\ndrape_" #name "_end:\n.byte 0\n.text\n"); \
  extern "C" const char drape_##name##_begin[], drape_##name##_end[];                          \
  const std::string_view drape::bench::embedded::name(drape_##name##_begin, drape_##name##_end)

DRAPE_EMBED(head_html, DRAPE_REPORT "/head.html");
DRAPE_EMBED(body_html, DRAPE_REPORT "/body.html");
DRAPE_EMBED(style_css, DRAPE_REPORT "/style.css");
DRAPE_EMBED(plotly_js, DRAPE_PLOTLY);
DRAPE_EMBED(three_js, DRAPE_THREE);
DRAPE_EMBED(orbit_controls_js, DRAPE_ORBIT_CONTROLS);
DRAPE_EMBED(data_js, DRAPE_REPORT "/data.js");
DRAPE_EMBED(tables_js, DRAPE_REPORT "/tables.js");
DRAPE_EMBED(looks_js, DRAPE_REPORT "/looks.js");
DRAPE_EMBED(plots_js, DRAPE_REPORT "/plots.js");
DRAPE_EMBED(figures_js, DRAPE_REPORT "/figures.js");
DRAPE_EMBED(run_figures_js, DRAPE_REPORT "/run_figures.js");
DRAPE_EMBED(motion_js, DRAPE_REPORT "/motion.js");
DRAPE_EMBED(player_js, DRAPE_REPORT "/player.js");
DRAPE_EMBED(report_js, DRAPE_REPORT "/report.js");
