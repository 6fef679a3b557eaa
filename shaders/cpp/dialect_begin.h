// The macros of the lobe dialect for C++. No include guard: paired with dialect_end.h around every namespace that reads .glsl text.
#define CHIARO_CPP 1
#define FN inline
#define CONST inline const
#define IN(T) const T&
#define OUT(T) T&
#define INOUT(T) T&
#define OUT_ARRAY(T, name, size) T (&name)[size]
