#pragma once
/// Inner loops written once, run in the widest registers there are.

#include <array>
#include <cstdint>
#include <cstring>
#if defined(__x86_64__) && !defined(__clang__)
#include <immintrin.h>  // declares the built-in functions
#endif

namespace chiaro {

/// Compiler vector extensions: element-wise + - * < ?:. One of these at a time is what a register holds; wider ones compile, badly.
using Float4 __attribute__((vector_size(16), may_alias)) = float;
using Float8 __attribute__((vector_size(32), may_alias)) = float;
using Float16 __attribute__((vector_size(64), may_alias)) = float;

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

// What vector extensions have no word for. GCC's built-in functions check for AVX only once they are inlined where it is enabled; Clang's before.
#if defined(__x86_64__) && !defined(__clang__)
#define CHIARO_BUILTINS 1
#endif
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpsabi"

/// Replaces the elements by their square roots.
template <typename Vector>
[[gnu::always_inline]] inline void takeSquareRoot(Vector& v) {
#if defined(CHIARO_BUILTINS)
  if constexpr (sizeof(Vector) == 64)
    v = __builtin_ia32_sqrtps512_mask(v, v, -1, _MM_FROUND_CUR_DIRECTION);
  else if constexpr (sizeof(Vector) == 32)
    v = __builtin_ia32_sqrtps256(v);
  else
    v = __builtin_ia32_sqrtps(v);
#else
  for (int i = 0; i < kWidth<Vector>; ++i) v[i] = __builtin_sqrtf(v[i]);
#endif
}

/// A bit for each element of a comparison's result that is true.
template <typename Vector, typename Mask>
[[gnu::always_inline]] inline unsigned trueElements(const Mask& mask) {
#if defined(CHIARO_BUILTINS)
  if constexpr (sizeof(Vector) == 32)
    return static_cast<unsigned>(__builtin_ia32_movmskps256(reinterpret_cast<const Vector&>(mask)));
  else
    return static_cast<unsigned>(__builtin_ia32_movmskps(reinterpret_cast<const Vector&>(mask)));
#else
  unsigned result = 0;
  for (int i = 0; i < kWidth<Vector>; ++i) result |= (mask[i] != 0 ? 1u : 0u) << i;
  return result;
#endif
}

/// The least element; the largest of all is -leastElement(-v).
template <typename Vector>
[[gnu::always_inline]] inline float leastElement(const Vector& v) {
  if constexpr (kWidth<Vector> == 4) {
    const Vector swapped = __builtin_shufflevector(v, v, 2, 3, 0, 1), pair = v < swapped ? v : swapped;
    return pair[0] < pair[1] ? pair[0] : pair[1];
  } else if constexpr (kWidth<Vector> == 8) {
    const Float4 low = __builtin_shufflevector(v, v, 0, 1, 2, 3), high = __builtin_shufflevector(v, v, 4, 5, 6, 7);
    const Float4 both = low < high ? low : high;
    return leastElement(both);
  } else {
    const Float8 low = __builtin_shufflevector(v, v, 0, 1, 2, 3, 4, 5, 6, 7), high = __builtin_shufflevector(v, v, 8, 9, 10, 11, 12, 13, 14, 15);
    const Float8 both = low < high ? low : high;
    return leastElement(both);
  }
}

/// A bit for each element of `a` that is at least that of `b`.
template <typename Vector>
[[gnu::always_inline]] inline unsigned elementsAtLeast(const Vector& a, const Vector& b) {
#if defined(CHIARO_BUILTINS)
  if constexpr (sizeof(Vector) == 64) return __builtin_ia32_cmpps512_mask(a, b, _CMP_GE_OQ, 0xffff, _MM_FROUND_CUR_DIRECTION);
  else
#endif
    return trueElements<Vector>(a >= b);
}

/// By the bits of a byte: which of eight elements are kept, first ones first.
inline constexpr auto kPacked = [] {
  struct alignas(32) Order {
    std::int32_t element[8] = {};
  };
  std::array<Order, 256> result{};
  for (unsigned bits = 0; bits < 256; ++bits) {
    int kept = 0;
    for (int i = 0; i < 8; ++i)
      if ((bits >> i & 1u) != 0) result[bits].element[kept++] = i;
  }
  return result;
}();

/// Floats that storePacked() takes.
template <typename Vector>
inline constexpr int kPackedAtOnce = kWidth<Vector> > 8 ? kWidth<Vector> : 8;

/// Writes those of kPackedAtOnce aligned floats whose bit is set to `to`, one behind the other; always writes as many, the rest of no
/// meaning. May be used in place, forwards.
template <typename Vector>
[[gnu::always_inline]] inline void storePacked(const float* aligned, unsigned bits, float* to) {
#if defined(CHIARO_BUILTINS)
  if constexpr (sizeof(Vector) == 64) {
    const Vector packed = __builtin_ia32_compresssf512_mask(loadVector<Vector>(aligned), Vector{}, static_cast<std::uint16_t>(bits));
    std::memcpy(to, &packed, sizeof(packed));
    return;
  }
#endif
  const auto& order = kPacked[bits & 0xffu];
#if defined(CHIARO_BUILTINS)
  if constexpr (sizeof(Vector) == 32) {
    using Int8 __attribute__((vector_size(32), may_alias)) = int;
    const Vector packed = __builtin_ia32_permvarsf256(loadVector<Vector>(aligned), *reinterpret_cast<const Int8*>(order.element));
    std::memcpy(to, &packed, sizeof(packed));
    return;
  }
#endif
  float kept[8];
  for (int i = 0; i < 8; ++i) kept[i] = aligned[order.element[i]];
  std::memcpy(to, kept, sizeof(kept));
}

#pragma GCC diagnostic pop

/// Put after the parameters of a lambda for runVectorised().
#define CHIARO_INLINE __attribute__((always_inline))

/// Floats in the widest vector that this machine has. Tests lower it: results must not depend on it.
inline int& widestVector() {
  static int width = [] {
#if defined(CHIARO_BUILTINS)
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl")) return 16;
#endif
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx2")) return 8;
#endif
    return 4;
  }();
  return width;
}

// No fused multiply-add among them: every machine gives the same bits.
#if defined(__x86_64__)
template <typename Kernel>
[[gnu::target("avx2")]] void runWithAvx2(const Kernel& kernel) {
  kernel.template operator()<Float8>();
}
#endif
#if defined(CHIARO_BUILTINS)
template <typename Kernel>
[[gnu::target("avx512f,avx512dq,avx512vl")]] void runWithAvx512(const Kernel& kernel) {
  kernel.template operator()<Float16>();
}
#endif

/// Runs `kernel`, a lambda `[&]<typename Vector>() CHIARO_INLINE {...}`, with the vector type that suits this machine, of four or eight. It
/// should copy what it captures into locals: stores through Vector may alias everything.
template <typename Kernel>
void runVectorised(const Kernel& kernel) {
#if defined(__x86_64__)
  if (widestVector() >= 8) {
    runWithAvx2(kernel);
    return;
  }
#endif
  kernel.template operator()<Float4>();
}

/// The same for a kernel that does with vectors of sixteen as well, which pays where most of it is arithmetic.
template <typename Kernel>
void runInWidest(const Kernel& kernel) {
#if defined(CHIARO_BUILTINS)
  if (widestVector() >= 16) {
    runWithAvx512(kernel);
    return;
  }
#endif
  runVectorised(kernel);
}

}  // namespace chiaro
