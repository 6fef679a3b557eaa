#pragma once
/// Which matrix products a bake computes with: they round differently from one processor to the next.

#include <string>

namespace chiaro {

/// The BLAS with its version, and the processor that its kernels are made for.
std::string blasName();

}  // namespace chiaro
