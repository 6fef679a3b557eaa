#pragma once
/// Makes the tables of reflectance_table.h. The build does it once (fit_tables.cpp), as it takes many seconds of one core.

#include <vector>

#include "runtime/brdf/reflectance_table.h"

namespace chiaro {

/// Deterministic whatever `threads` (0: all cores).
ReflectanceTable makeReflectanceTable(int kind, int widthCount = ReflectanceTable::kWidths,
                                      int cosineCount = ReflectanceTable::kCosines, int threads = 0);

/// One fit of `count` lobes in the plane of incidence (1, 3, 5 or 7) to one slice, F = 1, from several starts: what a table could reach.
std::vector<SliceLobe> fitSliceLobes(int kind, double parameter, double cosineOut, int count);

}  // namespace chiaro
