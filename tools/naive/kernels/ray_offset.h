// SPDX-License-Identifier: Apache-2.0
// How rays leave a surface after Waechter and Binder (2019, Ray Tracing Gems, ch. 6), in place of surface_origin: by 256 units
// in the last place of each coordinate, near the origin by a fixed length. For comparison only; float alone.
static inline real3 surface_origin(const Surface* surface, bool reflects, real3 w)
{
    const real3 n = reflects ? surface->normal_g : -surface->normal_g;
    const real3 p = surface->position;
    const int3 steps = convert_int3(n * 256.0f);
    const real3 far_away = as_float3(as_int3(p) + select(steps, -steps, p < 0.0f));
    return select(far_away, fma((real3)(1.0f / 65536.0f), n, p), fabs(p) < (real3)(1.0f / 32.0f));
}
