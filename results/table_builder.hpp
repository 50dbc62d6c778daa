#pragma once

#include <string>

#include "results/table.hpp"

namespace drape::results {

/// Builds a table row by row. A column exists from its first value on; rows without one have an empty cell.
class TableBuilder {
 public:
  TableBuilder(std::string name, std::string description) : table_{std::move(name), std::move(description), {}} {}

  /// Begins a row: what follows is in it.
  void row() { ++rows_; }

  /// `title` is what people see above the column; empty if they do not see it.
  void text(const char* name, const char* title, const char* description, std::string value);
  void number(const char* name, const char* title, const char* unit, const char* description, double value);
  void count(const char* name, const char* title, const char* description, std::int64_t value);

  /// The rows of another table, as if they had been built here.
  void append(const Table& rows);

  /// The table, all columns filled up to the same length.
  Table finish();

 private:
  void put(const std::string& name, const std::string& title, const std::string& unit, const std::string& description,
           Cell value);

  Table table_;
  std::size_t rows_ = 0;
};

}  // namespace drape::results
