#pragma once
/// Inner loops written once, run in the widest registers there are.

namespace chiaro {

/// Compiler vector extensions: element-wise + - * < ?:. One of these at a time is what a register holds; wider ones compile, badly.
using Float4 __attribute__((vector_size(16), may_alias)) = float;
using Float8 __attribute__((vector_size(32), may_alias)) = float;

/// Floats in a vector.
template <typename Vector>
inline constexpr int kWidth = static_cast<int>(sizeof(Vector) / sizeof(float));

template <typename Vector>
[[gnu::always_inline]] inline const Vector& loadVector(const float* aligned) {
  return *reinterpret_cast<const Vector*>(aligned);
}

template <typename Vector>
[[gnu::always_inline]] inline void storeVector(float* aligned, const Vector& value) {
  *reinterpret_cast<Vector*>(aligned) = value;
}

/// Put after the parameters of a lambda for runVectorised().
#define CHIARO_INLINE __attribute__((always_inline))

#if defined(__x86_64__)
/// No fused multiply-add among them: every machine gives the same bits.
template <typename Kernel>
[[gnu::target("avx2")]] void runWithAvx2(const Kernel& kernel) {
  kernel.template operator()<Float8>();
}

inline bool hasAvx2() {
  static const bool has = __builtin_cpu_supports("avx2") != 0;
  return has;
}
#endif

/// Runs `kernel`, a lambda `[&]<typename Vector>() CHIARO_INLINE {...}`, with the vector type that suits this machine. It should copy
/// what it captures into locals: stores through Vector may alias everything.
template <typename Kernel>
void runVectorised(const Kernel& kernel) {
#if defined(__x86_64__)
  if (hasAvx2()) {
    runWithAvx2(kernel);
    return;
  }
#endif
  kernel.template operator()<Float4>();
}

}  // namespace chiaro
