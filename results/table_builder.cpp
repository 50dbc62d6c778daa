#include "results/table_builder.hpp"

#include <algorithm>

#include "results/file/schema_4.hpp"

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

void TableBuilder::append(const Table& rows) {
  const std::size_t count = rows.columns.empty() ? 0 : rows.columns.front().cells.size();
  for (std::size_t k = 0; k < count; ++k) {
    row();
    for (const Column& c : rows.columns)
      if (!std::holds_alternative<std::monostate>(c.cells[k])) put(c.name, c.title, c.unit, c.description, c.cells[k]);
  }
}

void TableBuilder::put(const std::string& name, const std::string& title, const std::string& unit,
                       const std::string& description, Cell value) {
  auto column = std::ranges::find(table_.columns, name, &Column::name);
  if (column == table_.columns.end())
    column = table_.columns.insert(table_.columns.end(), {name, title, unit, description, usual_role(name, unit), {}, {}});
  column->cells.resize(rows_);
  column->cells.back() = std::move(value);
}

Table TableBuilder::finish() {
  for (Column& column : table_.columns) column.cells.resize(rows_);
  return std::move(table_);
}

}  // namespace drape::results
