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
DRAPE_EMBED(report_js, DRAPE_BUNDLE);
