// The dialect of shaders/lobe, GLSL side. C++ reads shaders/cpp/dialect.h instead.
//
// Rules that keep one text valid in GLSL 4.50, float C++ and double C++:
//   Real literals are written Real(2.0); no swizzle writes; parameters declared IN are never assigned;
//   structs are made by a function, not a constructor; no name that GLSL reserves (sample, filter, half, ...).
//
// Non-finite inputs, everywhere in shaders/lobe: NaN in gives NaN out. Negative sharpness gives NaN. Sharpness above
// kMaxSharpness, +inf included, is taken as kMaxSharpness, which behaves as the limit of an infinitely sharp lobe.
#define Real float
#define Vec2 vec2
#define Vec3 vec3
#define Vec4 vec4
#define Mat3 mat3
#define IVec2 ivec2
#define FN
#define CONST const
#define IN(T) T
#define OUT(T) out T
#define INOUT(T) inout T
#define OUT_ARRAY(T, name, size) out T name[size]

// By its bits: compilers may assume that x == x, and turn comparisons into min and max, which drop NaN.
bool isNotANumber(float x) { return (floatBitsToUint(x) & 0x7fffffffu) > 0x7f800000u; }
float notANumber() { return uintBitsToFloat(0x7fc00000u); }
float positiveInfinity() { return uintBitsToFloat(0x7f800000u); }
