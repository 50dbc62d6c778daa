#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace drape::bench {

/// Points of a plot, all positive; joined by a staircase, or alone.
struct Series {
  std::string name;
  std::vector<double> x, y;
  bool joined = true;
};

/// Two quantities on logarithmic scales.
struct Plot {
  std::string title, x_title, y_title;
  std::vector<Series> series;
  double uncertain_below = 0;  ///< values of x that are shaded; 0 for none
};

/// Draws a plot to `stem`.svg and `stem`.png with gnuplot, whose script is left in `stem`.gp. Returns an empty text, or why it
/// could not be drawn. Throws results::FileError if the script cannot be written.
std::string draw(const Plot& plot, const std::filesystem::path& stem);

}  // namespace drape::bench
