#include "results/columns.hpp"

namespace drape::results::detail {

std::string filled(std::string_view text, std::string_view filling) {
  const std::size_t place = text.find("{}");
  std::string result(text);
  return place == std::string_view::npos ? result : result.replace(place, 2, filling);
}

}  // namespace drape::results::detail
