// Takes dialect_begin.h back, so that IN and OUT never reach another header.
#undef CHIARO_CPP
#undef FN
#undef CONST
#undef IN
#undef OUT
#undef INOUT
#undef OUT_ARRAY
