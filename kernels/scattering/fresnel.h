// SPDX-License-Identifier: Apache-2.0
// Fresnel reflectance and Snell's law.
#ifndef CLRT_SCATTERING_FRESNEL_H
#define CLRT_SCATTERING_FRESNEL_H

#include "numerics/vector.h"

/* cos of the refracted angle, squared: 1 - eta^2 (1 - cos_i^2), where eta = index on the incident side over
   index on the other; not positive under total internal reflection. Both products are carried with their
   rounding errors, so the critical angle is met to the last float. */
static inline real fresnel_cos_t_squared(real cos_i, real eta)
{
    const real ec = eta * cos_i;
    const real ec_error = fma(eta, cos_i, -ec);
    const real p = ec * ec;
    const real p_error = fma(ec, ec, -p);
    /* eta^2 - 1 as a sum of two numbers (two-product, then two-sum). */
    const real q = eta * eta;
    const real q_error = fma(eta, eta, -q);
    const real m = q - REAL(1.0);
    const real t = m - q;
    const real m_error = ((q - (m - t)) - (REAL(1.0) + t)) + q_error;
    return (p - m) + (fma(REAL(2.0) * ec, ec_error, p_error) - m_error);
}

/* Reflectance of a smooth dielectric for unpolarised light, and the cosine of the refracted angle; 1 and 0
   under total internal reflection. cos_i in [0, 1]; eta as above. */
static inline real fresnel_dielectric(real cos_i, real eta, real* cos_t)
{
    /* Equal indices: nothing is reflected at any angle. */
    if (eta == REAL(1.0)) {
        *cos_t = cos_i;
        return REAL(0.0);
    }
    const real cos_t_squared = fresnel_cos_t_squared(cos_i, eta);
    if (cos_t_squared <= REAL(0.0)) {
        *cos_t = REAL(0.0);
        return REAL(1.0);
    }
    *cos_t = real_sqrt(cos_t_squared);
    const real ec = eta * cos_i;
    const real s = (ec - *cos_t) / (ec + *cos_t);
    const real et = eta * *cos_t;
    const real p = (cos_i - et) / (cos_i + et);
    return REAL(0.5) * fma(s, s, p * p);
}

/* Its mean over a hemisphere of equal radiance. On the denser side 1 - F is smaller by the squared index, as
   radiance is; on the other Kulla's and Conty's fit (2017), within 1e-3 up to an index of 3. */
static inline real fresnel_dielectric_mean(real eta)
{
    const real index = eta > REAL(1.0) ? eta : REAL(1.0) / eta;
    const real outside = (index - REAL(1.0)) / fma(REAL(1.00071), index, REAL(4.08567));
    return eta > REAL(1.0) ? REAL(1.0) - (REAL(1.0) - outside) / (index * index) : outside;
}

/* What Schlick's approximation adds towards grazing incidence. */
static inline real fresnel_schlick_grazing(real cos_i)
{
    const real m = clamp(REAL(1.0) - cos_i, REAL(0.0), REAL(1.0));
    const real m2 = m * m;
    return m2 * m2 * m;
}

/* Schlick's approximation (1994): f0 head-on, 1 at grazing incidence. */
static inline real3 fresnel_schlick(real3 f0, real cos_i)
{
    return f0 + ((real3)(REAL(1.0)) - f0) * fresnel_schlick_grazing(cos_i);
}

/* The mean of (1 - cos)^5 over a hemisphere of equal radiance, 1 / 21, and that of Schlick's reflectance. */
#define FRESNEL_SCHLICK_MEAN REAL(0.047619047619047619)

static inline real3 fresnel_schlick_mean(real3 f0)
{
    return f0 + ((real3)(REAL(1.0)) - f0) * FRESNEL_SCHLICK_MEAN;
}

/* Reflectance of a conductor of index eta + i k beside air for unpolarised light. With a + i b the root of
   (eta + i k)^2 - sin^2, where a b = eta k and a^2 - b^2 = eta^2 - k^2 - sin^2, it is a quotient of sums of
   squares for either polarisation (Born and Wolf 1999, sec. 14.2), so nothing cancels. Indices are those of
   src/scene/build_material.h: CONDUCTOR_SMALLEST_ETA and up, CONDUCTOR_LARGEST_INDEX at most. */
static inline real fresnel_conductor(real cos_i, real eta, real k)
{
    const real cosine = clamp(cos_i, REAL(0.0), REAL(1.0));
    const real c2 = cosine * cosine;
    const real s2 = (REAL(1.0) - cosine) * (REAL(1.0) + cosine);
    const real product = eta * k;
    /* eta^2 - k^2 - sin^2, whose ones cancel where the boundary is faint. */
    const real difference = fma(-k, k, (eta - REAL(1.0)) * (eta + REAL(1.0))) + c2;
    const real root = real_sqrt(fma(difference, difference, REAL(4.0) * product * product));
    const real larger = REAL(0.5) * (root + fabs(difference));
    const real smaller = larger > REAL(0.0) ? product * (product / larger) : REAL(0.0);
    const real b2 = difference >= REAL(0.0) ? smaller : larger;
    const real a = real_sqrt(difference >= REAL(0.0) ? larger : smaller);
    const real sum = fma(a + cosine, a + cosine, b2);
    /* An index of 1 + 0 i at grazing incidence: there is no boundary. */
    if (sum == REAL(0.0))
        return REAL(0.0);
    const real s = fma(a - cosine, a - cosine, b2) / sum;
    const real ac = a * cosine;
    const real p = fma(ac - s2, ac - s2, b2 * c2) / fma(ac + s2, ac + s2, b2 * c2);
    return REAL(0.5) * fma(s, p, s);
}

/* The same of three channels. */
static inline real3 fresnel_conductor_color(real cos_i, real3 eta, real3 k)
{
    return (real3)(fresnel_conductor(cos_i, eta.x, k.x), fresnel_conductor(cos_i, eta.y, k.y),
                   fresnel_conductor(cos_i, eta.z, k.z));
}

/* Its mean over a hemisphere of equal radiance, 2 int F(c) c dc, by Gauss's rule of three nodes for the
   weight c (Abramowitz and Stegun 1972, table 25.8): within 2e-3 for metals. */
static inline real3 fresnel_conductor_mean(real3 eta, real3 k)
{
    return fresnel_conductor_color(REAL(0.21234053823915295), eta, k) * REAL(0.13965395980291398) +
           fresnel_conductor_color(REAL(0.59053313555926529), eta, k) * REAL(0.45848221271917015) +
           fresnel_conductor_color(REAL(0.91141204048729605), eta, k) * REAL(0.40186382747791587);
}

/* The refracted direction of wo about the normal n on wo's side; cos_t as given by fresnel_dielectric. */
static inline real3 fresnel_refract(real3 wo, real3 n, real cos_i, real cos_t, real eta)
{
    return vector_normalize(n * fma(eta, cos_i, -cos_t) - eta * wo);
}

#endif
