#pragma once
/// The fitted tables that travel inside the library; the source is written by fit_tables.cpp when the library is built.

#include <span>

namespace chiaro {

/// ReflectanceTable::entries of a model (kCookTorrance .. kAshikhminShirley, the last with equal exponents) at its default size, four numbers each. Throws std::out_of_range.
std::span<const float> embeddedTable(int kind);

}  // namespace chiaro
