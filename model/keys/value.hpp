#pragma once

#include <toml++/toml.h>

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "model/keys/scene_error.hpp"
#include "model/sheet/sheet.hpp"

namespace drape::model {

/// A TOML node that knows where it came from, read with checks. Every function throws SceneError with the place, the key and
/// what would be right.
class Value {
 public:
  Value(const toml::node& node, std::string key, std::string origin)
      : node_(node), key_(std::move(key)), origin_(std::move(origin)) {}

  const std::string& key() const { return key_; }
  [[noreturn]] void fail(const std::string& what_is_right) const;

  std::string text() const;
  std::string title() const;  ///< a text of at most 200 characters
  bool flag() const;
  double number() const;                            ///< finite
  double positive() const;                          ///< > 0
  double non_negative() const;                      ///< ≥ 0
  double part() const;                              ///< > 0 and ≤ 1
  double part_or_none() const;                      ///< ≥ 0 and ≤ 1
  double up_to_two() const;                         ///< > 0 and ≤ 2
  int count() const;                                ///< a whole number ≥ 1
  std::vector<Value> list(std::size_t size) const;  ///< an array of `size` values
  std::vector<Value> list() const;                  ///< an array
  const toml::table& table() const;

  /// An array of rows of numbers.
  template <std::size_t rows, std::size_t columns>
  std::array<std::array<double, columns>, rows> numbers() const {
    std::array<std::array<double, columns>, rows> all{};
    const std::vector<Value> lines = list(rows);
    for (std::size_t i = 0; i < rows; ++i) {
      const std::vector<Value> row = lines[i].list(columns);
      for (std::size_t k = 0; k < columns; ++k) all[i][k] = row[k].number();
    }
    return all;
  }

  /// The absolute path of a file that can be read and is not larger than that, given from the folder of the scene's file; of
  /// overrides and built-in scenes from the working folder. `what`: "the file of a mesh".
  std::string input_file(std::string_view what, std::uintmax_t most_bytes) const;

  bool is_list() const { return node_.is_array(); }

  /// A node inside this one, called "key.name".
  Value child(std::string_view name, const toml::node& node) const { return {node, key_ + "." + std::string(name), origin_}; }

  /// One value for weft and warp, or an array of two; each read by `one`.
  WeftWarp weft_warp(double (Value::*one)() const) const;

  /// An array of three values, each read by `one`.
  Eigen::Vector3d vector(double (Value::*one)() const) const;

  /// The place of a text among the names.
  std::size_t one_of(std::span<const std::string_view> names) const;

 private:
  std::string shown() const;

  const toml::node& node_;
  std::string key_, origin_;
};

/// "file.toml:12" for a node, or the origin alone if it has no line.
std::string place(const std::string& origin, const toml::node& node);

}  // namespace drape::model
