#include "results/table_builder.hpp"

#include <algorithm>

namespace drape::results {

void TableBuilder::text(const char* name, const char* title, const char* description, std::string value) {
  put(name, title, "", description, std::move(value));
}

void TableBuilder::number(const char* name, const char* title, const char* unit, const char* description, double value) {
  put(name, title, unit, description, value);
}

void TableBuilder::count(const char* name, const char* title, const char* description, std::int64_t value) {
  put(name, title, "1", description, value);
}

void TableBuilder::put(const char* name, const char* title, const char* unit, const char* description, Cell value) {
  auto column = std::ranges::find(table_.columns, name, &Column::name);
  if (column == table_.columns.end())
    column = table_.columns.insert(table_.columns.end(), {name, title, unit, description, {}, {}});
  column->cells.resize(rows_);
  column->cells.back() = std::move(value);
}

Table TableBuilder::finish() {
  for (Column& column : table_.columns) column.cells.resize(rows_);
  return std::move(table_);
}

}  // namespace drape::results
