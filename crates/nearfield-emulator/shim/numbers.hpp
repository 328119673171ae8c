// Arithmetic intrinsics. The compiler neither contracts nor reorders, so that `_rn` functions are plain operators.

#pragma once

#include <type_traits>

namespace emulator {

template <class To, class From> To bits(From from) {
    static_assert(sizeof(To) == sizeof(From), "reinterpretation keeps the size");
    To to;
    memcpy(&to, &from, sizeof(To));
    return to;
}

// Rounded to nearest, the ends of the range where it is beyond and zero for NaN, as the device converts.
inline long long rounded(double x) {
    if (x != x) return 0;
    if (x >= 9223372036854775808.0) return 0x7fffffffffffffffll;
    if (x <= -9223372036854775808.0) return -0x7fffffffffffffffll - 1;
    return llrint(x);
}

inline int rounded_int(double x) {
    const long long r = rounded(x);
    return r > 0x7fffffffll ? 0x7fffffff : r < -0x80000000ll ? -0x7fffffff - 1 : (int)r;
}

inline unsigned rounded_uint(double x) {
    const long long r = rounded(x);
    return r > 0xffffffffll ? 0xffffffffu : r < 0 ? 0u : (unsigned)r;
}

} // namespace emulator

inline float __uint_as_float(unsigned x) { return emulator::bits<float>(x); }
inline unsigned __float_as_uint(float x) { return emulator::bits<unsigned>(x); }
inline float __int_as_float(int x) { return emulator::bits<float>(x); }
inline int __float_as_int(float x) { return emulator::bits<int>(x); }
inline double __longlong_as_double(long long x) { return emulator::bits<double>(x); }
inline long long __double_as_longlong(double x) { return emulator::bits<long long>(x); }

inline int __float2int_rn(float x) { return emulator::rounded_int(x); }
inline int __float2int_rd(float x) { return emulator::rounded_int(floorf(x)); }
inline int __float2int_rz(float x) { return emulator::rounded_int(truncf(x)); }
inline unsigned __float2uint_rn(float x) { return emulator::rounded_uint(x); }
inline unsigned __float2uint_rd(float x) { return emulator::rounded_uint(floorf(x)); }
inline unsigned __float2uint_rz(float x) { return emulator::rounded_uint(truncf(x)); }
inline long long __float2ll_rn(float x) { return emulator::rounded(x); }
inline long long __float2ll_rd(float x) { return emulator::rounded(floorf(x)); }
inline int __double2int_rn(double x) { return emulator::rounded_int(x); }
inline long long __double2ll_rn(double x) { return emulator::rounded(x); }
inline float __double2float_rn(double x) { return (float)x; }
inline float __double2float_ru(double x) {
    const float nearest = (float)x;
    return (double)nearest < x ? nextafterf(nearest, INFINITY) : nearest;
}
inline float __double2float_rd(double x) {
    const float nearest = (float)x;
    return (double)nearest > x ? nextafterf(nearest, -INFINITY) : nearest;
}

inline float __fadd_rn(float a, float b) { return a + b; }
inline float __fsub_rn(float a, float b) { return a - b; }
inline float __fmul_rn(float a, float b) { return a * b; }
inline float __fdiv_rn(float a, float b) { return a / b; }
inline float __frcp_rn(float a) { return 1.0f / a; }
inline float __fsqrt_rn(float a) { return sqrtf(a); }
inline float __fmaf_rn(float a, float b, float c) { return fmaf(a, b, c); }
inline double __dadd_rn(double a, double b) { return a + b; }
inline double __dmul_rn(double a, double b) { return a * b; }
inline double __fma_rn(double a, double b, double c) { return fma(a, b, c); }
// Templates, because newer C libraries have functions of these names.
template <class T> T rsqrtf(T x) { return 1.0f / sqrtf(x); }
template <class T> T rsqrt(T x) { return 1.0 / sqrt(x); }
inline float __saturatef(float x) { return x > 0.0f ? (x < 1.0f ? x : 1.0f) : 0.0f; }
#ifdef __APPLE__
inline void sincos(double x, double* s, double* c) { *s = sin(x), *c = cos(x); }
inline void sincosf(float x, float* s, float* c) { *s = sinf(x), *c = cosf(x); }
#endif

inline int __popc(unsigned x) { return __builtin_popcount(x); }
inline int __popcll(unsigned long long x) { return __builtin_popcountll(x); }
inline int __ffs(int x) { return __builtin_ffs(x); }
inline int __ffsll(long long x) { return __builtin_ffsll(x); }
inline int __clz(int x) { return x == 0 ? 32 : __builtin_clz((unsigned)x); }
inline int __clzll(long long x) { return x == 0 ? 64 : __builtin_clzll((unsigned long long)x); }
inline unsigned __brev(unsigned x) {
    unsigned reversed = 0;
    for (int bit = 0; bit < 32; ++bit) reversed |= (x >> bit & 1) << (31 - bit);
    return reversed;
}
inline unsigned __umulhi(unsigned a, unsigned b) { return (unsigned)((unsigned long long)a * b >> 32); }

template <class A, class B> typename std::common_type<A, B>::type min(A a, B b) {
    typedef typename std::common_type<A, B>::type T;
    if constexpr (std::is_floating_point<T>::value) return (T)fmin((T)a, (T)b);
    else return (T)b < (T)a ? (T)b : (T)a;
}
template <class A, class B> typename std::common_type<A, B>::type max(A a, B b) {
    typedef typename std::common_type<A, B>::type T;
    if constexpr (std::is_floating_point<T>::value) return (T)fmax((T)a, (T)b);
    else return (T)a < (T)b ? (T)b : (T)a;
}

template <class T> T __ldg(const T* address) { return *address; }
template <class T> T __ldcg(const T* address) { return *address; }
template <class T> void __stcg(T* address, T value) { *address = value; }
