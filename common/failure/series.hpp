// Named columns of equal length: one row every few steps of a run. Shared by the solver (writes), the failure criteria and the record.
#pragma once

#include <cassert>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace fracfarm {

struct Column {
  std::string name;
  std::string unit;
  std::vector<double> values;
};

struct Series {
  std::vector<Column> columns;  // the first is step_time (s)

  std::size_t rows() const { return columns.empty() ? 0 : columns.front().values.size(); }
  const Column* find(std::string_view name) const {
    for (const Column& column : columns)
      if (column.name == name) return &column;
    return nullptr;
  }
  std::span<const double> operator[](std::string_view name) const {
    const Column* column = find(name);
    assert(column && "no such column");
    return column->values;
  }
};

}  // namespace fracfarm
