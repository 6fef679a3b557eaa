#pragma once
/// The transfer of a baked file, as the runtime reads it.

#include <memory>

#include "assets/transfer/transfer.h"
#include "precompute/report/visibility/visibility_method.h"

namespace chiaro {

/// `transfer` must outlive the method, and VisibilityInput::viewpoints must be those of its scene. Of the forms without levels only the SSDF
/// is asked; the visible fractions of fixed lobes are neither used nor counted.
std::unique_ptr<VisibilityMethod> makeTransferMethod(const Transfer& transfer);

}  // namespace chiaro
