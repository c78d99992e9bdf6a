// SPDX-License-Identifier: Apache-2.0
// One sum of the film: 64 bits in fixed point, least significant byte first. In builds of integrators that
// only gather, a pixel belongs to one work-item, which adds plainly. In builds with -DFILM_SPLATS=1 any
// work-item may add to any sum: by an atomic of 64 bits where the host has asked the device for it
// (-DFILM_INT64_ATOMICS=1) and the compiler offers it, else by two of 32 bits and a carry. The sum is the
// same: where in between its words do not belong together, nobody looks at it as a number.
#ifndef CLRT_FILM_SUM_H
#define CLRT_FILM_SUM_H

#ifndef FILM_SPLATS
#define FILM_SPLATS 0
#endif
#ifndef FILM_INT64_ATOMICS
#define FILM_INT64_ATOMICS 0
#endif

#if FILM_INT64_ATOMICS && defined(cl_khr_int64_base_atomics)
#define SUM_ADD_INT64
#pragma OPENCL EXTENSION cl_khr_int64_base_atomics : enable
#endif

/* Adds to a sum that nobody else adds to. It stays at its largest value instead of wrapping: for
   contributions that are not negative this is as free of order as adding. False where it is full. */
static inline bool sum_add_alone(global long* sum, long quanta)
{
    *sum = add_sat(*sum, quanta);
    return *sum != LONG_MAX;
}

/* Adds modulo 2^64 to a sum that others add to at the same time; the sum before, as this addition has met it
   (without its high word, where that stays). */
static inline ulong sum_add_modulo(global long* sum, ulong quanta)
{
#ifdef SUM_ADD_INT64
    return (ulong)atom_add((global volatile long*)sum, (long)quanta);
#else
    global volatile uint* words = (global volatile uint*)sum;
    const uint low = (uint)quanta;
    const uint before = atomic_add(words, low);
    const uint carry = before > UINT_MAX - low ? 1u : 0u;
    const uint high = (uint)(quanta >> 32) + carry;
    return upsample(high == 0u ? 0u : atomic_add(words + 1, high), before);
#endif
}

/* Adds 0 to 2^60 quanta to a sum that others add to. It is full from 2^63 on, which sets its sign, and the
   host reads that as the largest value. Whatever the order, a sum gets there in steps of less than 2^63, so
   that one of them sees it happen; who comes later takes back what it adds. False where it is full. */
static inline bool sum_add_shared(global long* sum, long quanta)
{
    if (quanta == 0)
        return true;
    const ulong before = sum_add_modulo(sum, (ulong)quanta);
    if (before >> 63) {
        sum_add_modulo(sum, 0ul - (ulong)quanta);
        return false;
    }
    return ((before + (ulong)quanta) >> 63) == 0ul;
}

/* Adds to a sum of this build's film. */
static inline bool sum_add(global long* sum, long quanta)
{
    return FILM_SPLATS ? sum_add_shared(sum, quanta) : sum_add_alone(sum, quanta);
}

#endif
