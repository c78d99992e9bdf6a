// SPDX-License-Identifier: Apache-2.0
// exp, log, pow, atan2 and acos of real. OpenCL leaves the last bits of its built-in ones to the device;
// these consist of correctly rounded operations and fma only, so every device that has those (device_facts.cl
// asks it) gives the same bits. Largest errors over all of the stated range, in units in the last place, as
// measured by real_functions_test.cpp:
//
//                      range               float   double
//     real_exp         all                 0.8     0.8
//     real_log         all                 0.8     0.8
//     real_pow         x >= 0, all y       0.8     1.0
//     real_atan2       all                 1.5     1.5
//     real_acos        [-1, 1]             1.9     1.9
//
// Methods: reduction by powers of two after Cody and Waite (1980); atanh series for logarithms, and 1 - r^2 /
// 2 kept apart, as in fdlibm (Sun Microsystems 1993); products in two parts by fma after Dekker (1971).
// tools/fit_functions.py derives the polynomials. Special values are those of C11, Annex F.
#ifndef CLRT_NUMERICS_REAL_FUNCTIONS_H
#define CLRT_NUMERICS_REAL_FUNCTIONS_H

#include "real.h"

#ifndef REAL_IS_FAST /* real.h has the native ones */

/* The format: bits of the mantissa, bias of the exponent, the bits of sqrt(1/2), and a power of two that
   makes subnormal numbers normal. LN2_HI has so many zeros at its end that its product with an exponent is
   exact, LN2_LO is what is missing. Names in _REST or _LO: what a constant of that type lacks. */
#ifdef REAL_IS_DOUBLE
typedef long real_bits;
#define REAL_AS_BITS(x) as_long(x)
#define REAL_OF_BITS(x) as_double(x)
#define REAL_MANTISSA_BITS 52
#define REAL_BIAS 1023
#define REAL_HALF_ROOT_BITS 0x3fe6a09e667f3bcdl
#define REAL_SMALLEST_NORMAL 2.2250738585072014e-308
#define REAL_TO_NORMAL 18014398509481984.0
#define REAL_TO_NORMAL_EXPONENT 54
#define REAL_LN2_HI 6.93147180369123816490e-01
#define REAL_LN2_LO 1.90821492927058770002e-10
#define REAL_EXP_LOWEST -746.0
#define REAL_EXP_HIGHEST 710.0
#define REAL_EXP2_LIMIT 1100.0
#define REAL_TWO_OVER_LN2_HI 2.8853900817779268
#define REAL_TWO_OVER_LN2_LO 4.0710547481862067e-17
#define REAL_LN2_REST 2.3190468138462996e-17
#define REAL_THIRD_LO 1.8503717077085943e-17
#define REAL_PI_LO 1.2246467991473532e-16
#else
typedef int real_bits;
#define REAL_AS_BITS(x) as_int(x)
#define REAL_OF_BITS(x) as_float(x)
#define REAL_MANTISSA_BITS 23
#define REAL_BIAS 127
#define REAL_HALF_ROOT_BITS 0x3f3504f3
#define REAL_SMALLEST_NORMAL 1.17549435e-38f
#define REAL_TO_NORMAL 33554432.0f
#define REAL_TO_NORMAL_EXPONENT 25
#define REAL_LN2_HI 0.693145751953125f
#define REAL_LN2_LO 1.42860677e-6f
#define REAL_EXP_LOWEST -104.0f
#define REAL_EXP_HIGHEST 89.0f
#define REAL_EXP2_LIMIT 160.0f
#define REAL_TWO_OVER_LN2_HI 2.88539004f
#define REAL_TWO_OVER_LN2_LO 3.85192607e-8f
#define REAL_LN2_REST -1.90465421e-9f
#define REAL_THIRD_LO -9.93410776e-9f
#define REAL_PI_LO -8.74227766e-8f
#endif

#define REAL_LN2 REAL(0.69314718055994530942)
#define REAL_LOG2_E REAL(1.44269504088896340736)
#define REAL_INFINITY REAL_OF_BITS((real_bits)(2 * REAL_BIAS + 1) << REAL_MANTISSA_BITS)

/* 2^n for exponents of normal numbers. */
static inline real real_power_of_two(int n)
{
    return REAL_OF_BITS((real_bits)(n + REAL_BIAS) << REAL_MANTISSA_BITS);
}

/* x 2^n, rounded once, for x around 1: in two steps, since 2^n alone may be neither normal nor finite. */
static inline real real_scale(real x, int n)
{
    const int half_n = n >> 1;
    return x * real_power_of_two(half_n) * real_power_of_two(n - half_n);
}

/* exp(r + rest) for |r| <= ln(2) / 2 and a rest below its last bit. */
static inline real real_exp_reduced(real r, real rest)
{
#ifdef REAL_IS_DOUBLE
    real p = fma(r, 2.5041475999489069e-08, 2.7629017664625707e-07);
    p = fma(r, p, 2.7557421828336842e-06);
    p = fma(r, p, 2.4801496403513478e-05);
    p = fma(r, p, 0.00019841269743681706);
    p = fma(r, p, 0.0013888888940838599);
    p = fma(r, p, 0.0083333333333486196);
    p = fma(r, p, 0.041666666666536893);
    p = fma(r, p, 0.16666666666666732);
    p = fma(r, p, 0.50000000000000111);
#else
    real p = fma(r, 0.00138393627f, 0.00836919434f);
    p = fma(r, p, 0.0416680984f);
    p = fma(r, p, 0.166665167f);
    p = fma(r, p, 0.49999994f);
#endif
    const real sum = REAL(1.0) + r;
    return sum + (((REAL(1.0) - sum) + r) + fma(r * r, p, rest));
}

static inline real real_exp(real x)
{
    /* Beyond these the result is 0 or infinite; a NaN passes. */
    const real in = x < REAL_EXP_LOWEST ? REAL_EXP_LOWEST : (x > REAL_EXP_HIGHEST ? REAL_EXP_HIGHEST : x);
    const real n = floor(fma(in, REAL_LOG2_E, REAL(0.5)));
    const real high = fma(n, -REAL_LN2_HI, in); /* exact */
    const real r = fma(n, -REAL_LN2_LO, high);
    return real_is_nan(x) ? x : real_scale(real_exp_reduced(r, fma(n, -REAL_LN2_LO, high - r)), (int)n);
}

/* Positive finite x = m 2^e with m in [sqrt(1/2), sqrt(2)). */
static inline real real_split(real x, real* e)
{
    const bool is_subnormal = x < REAL_SMALLEST_NORMAL;
    const real_bits bits = REAL_AS_BITS(is_subnormal ? x * REAL_TO_NORMAL : x) - REAL_HALF_ROOT_BITS;
    const int n = (int)(bits >> REAL_MANTISSA_BITS);
    *e = (real)(is_subnormal ? n - REAL_TO_NORMAL_EXPONENT : n);
    return REAL_OF_BITS((bits & (((real_bits)1 << REAL_MANTISSA_BITS) - 1)) + REAL_HALF_ROOT_BITS);
}

/* ln((1 + s) / (1 - s)) = 2 s + s R with R = z (2/3 + 2/5 z + ...) and z = s^2: this R over z. */
static inline real real_log_series(real z)
{
#ifdef REAL_IS_DOUBLE
    real p = fma(z, 0.13234718301869189, 0.13252155374152388);
    p = fma(z, p, 0.15386988477502639);
    p = fma(z, p, 0.18181778365465834);
    p = fma(z, p, 0.22222222606819786);
    p = fma(z, p, 0.28571428569412238);
    p = fma(z, p, 0.40000000000004921);
    return fma(z, p, 0.66666666666666663);
#else
    real p = fma(z, 0.242791057f, 0.284987867f);
    p = fma(z, p, 0.400009722f);
    return fma(z, p, 0.666666627f);
#endif
}

static inline real real_log(real x)
{
    if (!(x > REAL(0.0)))
        return x == REAL(0.0) ? -REAL_INFINITY : REAL_NAN;
    if (!real_is_finite(x))
        return x;
    real e;
    const real f = real_split(x, &e) - REAL(1.0); /* exact */
    /* ln(1 + f) = f - (h - s (h + R)) with s = f / (2 + f) and h = f^2 / 2. */
    const real s = f / (REAL(2.0) + f);
    const real z = s * s;
    const real h = REAL(0.5) * f * f;
    const real rest = fma(s, fma(z, real_log_series(z), h), e * REAL_LN2_LO);
    return fma(e, REAL_LN2_HI, f - (h - rest));
}

/* (atanh(s) / s - 1 - z / 3) / z^2 for z = s^2. */
static inline real real_atanh_series(real z)
{
#ifdef REAL_IS_DOUBLE
    real p = fma(z, 0.060150061699330959, 0.05139422798472134);
    p = fma(z, p, 0.058886361960994726);
    p = fma(z, p, 0.066664799068162736);
    p = fma(z, p, 0.07692311093215852);
    p = fma(z, p, 0.090909090530088582);
    p = fma(z, p, 0.1111111111135825);
    p = fma(z, p, 0.14285714285713444);
    return fma(z, p, 0.20000000000000001);
#else
    real p = fma(z, 0.097782068f, 0.110898644f);
    p = fma(z, p, 0.142859861f);
    return fma(z, p, 0.199999988f);
#endif
}

/* log2 of a positive finite number as the sum of two parts, the second small: so exact that a power of any
   size keeps its last bit. */
static inline real2 real_log2_parts(real x)
{
    real e;
    const real m = real_split(x, &e);
    /* s = (m - 1) / (m + 1), in two parts like all that follows. */
    const real f = m - REAL(1.0);
    const real d = m + REAL(1.0);
    const real d_rest = m > REAL(1.0) ? REAL(1.0) - (d - m) : m - (d - REAL(1.0));
    const real reciprocal = REAL(1.0) / d;
    const real s = f * reciprocal;
    const real s_rest = (fma(-s, d, f) - s * d_rest) * reciprocal;
    /* t = z / 3 + z^2 (1/5 + ...) with z = s^2. */
    const real z = s * s;
    const real z_rest = fma(s, s, -z) + REAL(2.0) * s * s_rest;
    const real third = REAL(0.33333333333333333333);
    const real z_third = z * third;
    const real tail = z * z * real_atanh_series(z);
    const real t = z_third + tail;
    const real t_rest =
        (z_third - t) + tail + (fma(z, third, -z_third) + fma(z, REAL_THIRD_LO, z_rest * third));
    /* atanh(s) = s + s t. */
    const real u = s * t;
    const real u_rest = fma(s, t, -u) + fma(s, t_rest, s_rest * t);
    const real a = s + u;
    const real a_rest = ((s - a) + u) + (u_rest + s_rest);
    /* log2(m) = 2 atanh(s) / ln(2), then the exponent. */
    const real log2_m = a * REAL_TWO_OVER_LN2_HI;
    const real log2_m_rest =
        fma(a, REAL_TWO_OVER_LN2_HI, -log2_m) + fma(a, REAL_TWO_OVER_LN2_LO, a_rest * REAL_TWO_OVER_LN2_HI);
    const real sum = e + log2_m;
    const real sum_rest = e == REAL(0.0) ? log2_m_rest : ((e - sum) + log2_m) + log2_m_rest;
    return (real2)(sum, sum_rest);
}

/* x^y for x >= 0; NaN for negative x. */
static inline real real_pow(real x, real y)
{
    if (y == REAL(0.0) || x == REAL(1.0))
        return REAL(1.0);
    if (!(x >= REAL(0.0)) || real_is_nan(y))
        return REAL_NAN;
    if (x == REAL(0.0) || !real_is_finite(x))
        return (x == REAL(0.0)) == (y > REAL(0.0)) ? REAL(0.0) : REAL_INFINITY;
    const real2 log2_x = real_log2_parts(x);
    const real p = y * log2_x.x;
    /* Far outside the range of exponents the second part does not matter, and might not be a number. */
    if (fabs(p) > REAL_EXP2_LIMIT)
        return p < REAL(0.0) ? REAL(0.0) : REAL_INFINITY;
    const real p_rest = fma(y, log2_x.x, -p) + y * log2_x.y;
    const real n = floor(p + REAL(0.5));
    const real r = p - n; /* exact */
    const real scaled = r * REAL_LN2;
    const real scaled_rest = fma(r, REAL_LN2, -scaled) + fma(r, REAL_LN2_REST, p_rest * REAL_LN2);
    const real sum = scaled + scaled_rest;
    return real_scale(real_exp_reduced(sum, (scaled - sum) + scaled_rest), (int)n);
}

/* atan(a) for a in [0, 1]. */
static inline real real_atan_unit(real a)
{
    const real z = a * a;
#ifdef REAL_IS_DOUBLE
    real p = fma(z, 1.3129203173391328e-05, -0.00015127749157515654);
    p = fma(z, p, 0.00082757812804732571);
    p = fma(z, p, -0.002875238784860088);
    p = fma(z, p, 0.0071794236774195804);
    p = fma(z, p, -0.013878763607194054);
    p = fma(z, p, 0.021964048813617302);
    p = fma(z, p, -0.029888710253560637);
    p = fma(z, p, 0.036633407551027307);
    p = fma(z, p, -0.042188097344755399);
    p = fma(z, p, 0.047221986606395226);
    p = fma(z, p, -0.052534870601969257);
    p = fma(z, p, 0.058805218395976286);
    p = fma(z, p, -0.066664032478575178);
    p = fma(z, p, 0.07692279766864249);
    p = fma(z, p, -0.090909069994872249);
    p = fma(z, p, 0.11111111007015036);
    p = fma(z, p, -0.14285714282582571);
    p = fma(z, p, 0.19999999999951748);
    p = fma(z, p, -0.33333333333333071);
#else
    real p = fma(z, -0.00178202102f, 0.0108659305f);
    p = fma(z, p, -0.0310931858f);
    p = fma(z, p, 0.0578787029f);
    p = fma(z, p, -0.0839920342f);
    p = fma(z, p, 0.109508604f);
    p = fma(z, p, -0.142640144f);
    p = fma(z, p, 0.199985296f);
    p = fma(z, p, -0.333332986f);
#endif
    return fma(z * a, p, a);
}

/* The angle of (x, y) from +x, in [-pi, pi], with the sign of y. */
static inline real real_atan2(real y, real x)
{
    if (real_is_nan(x) || real_is_nan(y))
        return REAL_NAN;
    const real ax = fabs(x);
    const real ay = fabs(y);
    const bool is_steep = ay > ax;
    const real larger = is_steep ? ay : ax;
    const real smaller = is_steep ? ax : ay;
    /* Neither 0 / 0 nor infinity over itself. */
    const real ratio = smaller == larger ? (larger == REAL(0.0) ? REAL(0.0) : REAL(1.0)) : smaller / larger;
    real angle = real_atan_unit(ratio);
    if (is_steep)
        angle = REAL(0.5) * REAL_PI - (angle - REAL(0.5) * REAL_PI_LO);
    if (REAL_AS_BITS(x) < 0) /* -0 too */
        angle = REAL_PI - (angle - REAL_PI_LO);
    return copysign(angle, y);
}

/* For x in [-1, 1]; NaN elsewhere. From the sine too, so that next to 1 no digits are lost. */
static inline real real_acos(real x)
{
    if (!(fabs(x) <= REAL(1.0)))
        return REAL_NAN;
    return real_atan2(real_sqrt((REAL(1.0) - x) * (REAL(1.0) + x)), x);
}

#endif

#endif
