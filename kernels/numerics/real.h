// SPDX-License-Identifier: Apache-2.0
// The number type of all kernels: float, or double for the oracle (--precision double). The only file that
// knows about precision, with real_functions.h; native functions (--precision fast) appear nowhere else.
#ifndef CLRT_NUMERICS_REAL_H
#define CLRT_NUMERICS_REAL_H

#include "device.h"

/* The compiler may not fuse a*b+c on its own: the same source must give the same bits whatever surrounds it.
   fma is written where it is wanted. */
#pragma OPENCL FP_CONTRACT OFF

/* The host says where the driver's own fma makes kernels too large to be compiled. */
#ifdef CLRT_SOFTWARE_FMA
#include "software_fma.h"
#define fma software_fma
#endif

#ifdef REAL_IS_DOUBLE
#pragma OPENCL EXTENSION cl_khr_fp64 : enable
typedef double real;
typedef double2 real2;
typedef double3 real3;
typedef double4 real4;
typedef double8 real8;
typedef long8 mask8; /* what comparing two real8 gives */
#define REAL(x) x
#define REAL_ROUNDING 1.1102230246251565e-16 /* u: half a unit in the last place of 1 */
#define convert_real3 convert_double3
#define convert_real8 convert_double8
#define REAL_NAN as_double(0x7ff8000000000000ul)
#define REAL_BITS_FINITE(x) ((as_ulong(x) & 0x7ff0000000000000ul) != 0x7ff0000000000000ul)
#define REAL_BITS_NAN(x) ((as_ulong(x) & 0x7ffffffffffffffful) > 0x7ff0000000000000ul)
#else
typedef float real;
typedef float2 real2;
typedef float3 real3;
typedef float4 real4;
typedef float8 real8;
typedef int8 mask8;
#define REAL(x) x##f
#define REAL_ROUNDING 5.9604645e-8f
#define convert_real3 convert_float3
#define convert_real8 convert_float8
#define REAL_NAN as_float(0x7fc00000u)
#define REAL_BITS_FINITE(x) ((as_uint(x) & 0x7f800000u) != 0x7f800000u)
#define REAL_BITS_NAN(x) ((as_uint(x) & 0x7fffffffu) > 0x7f800000u)
#endif

/* u of the scene's data, which is float in every precision. */
#define FLOAT_ROUNDING REAL(5.9604645e-8)

/* Far away: the length of an unbounded ray. Products with the clamped reciprocal direction stay finite. */
#define REAL_FAR REAL(1e18)

#define REAL_PI REAL(3.14159265358979323846)
#define REAL_INVERSE_PI REAL(0.31830988618379067154)

/* Square root: correctly rounded, like division, where the device keeps its promises (device_facts.cl asks
   it). */
#ifdef REAL_IS_FAST
#define real_sqrt(x) native_sqrt(x)
/* The rest of them is in real_functions.h otherwise. */
#define real_exp(x) native_exp(x)
#define real_log(x) native_log(x)
#define real_pow(x, y) native_powr(x, y)
#define real_atan2(y, x) atan2(y, x)
#define real_acos(x) acos(x)
#else
#define real_sqrt(x) sqrt(x)
#endif

/* NaN and infinity by their bits: relaxed maths may delete comparisons. */
static inline bool real_is_finite(real x) { return REAL_BITS_FINITE(x); }
static inline bool real_is_nan(real x) { return REAL_BITS_NAN(x); }

/* x in [0, 1]: clamp, but a NaN stays one, so that it reaches the film's count. */
static inline real real_unit(real x) { return x < REAL(0.0) ? REAL(0.0) : (x > REAL(1.0) ? REAL(1.0) : x); }

/* sqrt(max(x, 0)): for values that are non-negative but for rounding. */
static inline real real_root(real x) { return real_sqrt(fmax(x, REAL(0.0))); }

/* a b - c d with an error of at most 1.5 ulp and the exact sign (Kahan; Jeannerod, Louvet and Muller
   2013). */
static inline real real_difference_of_products(real a, real b, real c, real d)
{
    const real cd = c * d;
    return fma(a, b, -cd) + fma(-c, d, cd);
}

/* sin and cos of x in [-pi/4, pi/4] by their Taylor polynomials with minimised last coefficients; below 1 ulp
   in float. Only fma and products, so every device gives the same bits. */
static inline real2 real_sin_cos_quarter(real x)
{
    const real z = x * x;
#ifdef REAL_IS_DOUBLE
    real s = fma(z, -7.6471637318198164759e-13, 1.6059043836821614599e-10);
    s = fma(s, z, -2.5052108385441718775e-8);
    s = fma(s, z, 2.7557319223985890653e-6);
    s = fma(s, z, -1.9841269841269841270e-4);
    s = fma(s, z, 8.3333333333333333333e-3);
    s = fma(s, z, -1.6666666666666666667e-1);
    real c = fma(z, 4.7794773323873852974e-14, -1.1470745597729724714e-11);
    c = fma(c, z, 2.0876756987868098979e-9);
    c = fma(c, z, -2.7557319223985890653e-7);
    c = fma(c, z, 2.4801587301587301587e-5);
    c = fma(c, z, -1.3888888888888888889e-3);
    c = fma(c, z, 4.1666666666666666667e-2);
    c = fma(c, z, -0.5);
#else
    real s = fma(z, -1.9515295891e-4f, 8.3321608736e-3f);
    s = fma(s, z, -1.6666654611e-1f);
    real c = fma(z, 2.443315711809948e-5f, -1.388731625493765e-3f);
    c = fma(c, z, 4.166664568298827e-2f);
    c = fma(c, z, -0.5f);
#endif
    return (real2)(fma(s * z, x, x), fma(c, z, REAL(1.0)));
}

/* (sin, cos) of 2 pi u for u in [0, 1], by reduction to an eighth of a turn. */
static inline real2 real_sin_cos_turn(real u)
{
    const real eighths = u * REAL(8.0);
    const int octant = (int)eighths;
    /* Odd octants measure back from their end, so the argument stays within a quarter of pi. */
    const real part = (octant & 1) ? (real)(octant + 1) - eighths : eighths - (real)octant;
    const real2 sc = real_sin_cos_quarter(part * (REAL_PI * REAL(0.25)));
    const bool swap = ((octant + 1) & 2) != 0;
    const real s = swap ? sc.y : sc.x;
    const real c = swap ? sc.x : sc.y;
    return (real2)((octant & 4) ? -s : s, ((octant + 2) & 4) ? -c : c);
}

#endif
