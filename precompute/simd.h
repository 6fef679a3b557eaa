#pragma once
/// Sixteen floats at once, whatever the machine has for them; and functions compiled once more for wider registers.

namespace chiaro {

/// One 4x4 tile of texels. Compiler vector extension: element-wise + - * < ?:.
using Float16 __attribute__((vector_size(64), may_alias)) = float;
using Int16 __attribute__((vector_size(64), may_alias)) = int;

// A sanitizer's start-up and the resolver of a cloned function do not go together.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
/// No fused multiply-add among them: every machine gives the same bits.
#define CHIARO_CLONES __attribute__((target_clones("avx2", "default")))
#else
#define CHIARO_CLONES
#endif

}  // namespace chiaro
