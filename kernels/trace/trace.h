// SPDX-License-Identifier: Apache-2.0
// Hooks that record what a sample does. Without -DCLRT_TRACE they are nothing, and so is their cost; with it,
// the same code computes the same bits and writes each value down on the way (src/replay).
#ifndef CLRT_TRACE_TRACE_H
#define CLRT_TRACE_TRACE_H

#include "numerics/sampler.h"
#include "shared/trace_types.h"

#ifdef CLRT_TRACE

/* The record of the sample at hand. */
typedef struct {
    global ulong* events;
    uint capacity, count;
    uint decisions; /* hash of the choices so far */
} Trace;

#ifdef REAL_IS_DOUBLE
#define TRACE_BITS(x) as_ulong(x)
#else
#define TRACE_BITS(x) ((ulong)as_uint(x))
#endif

static inline void trace_put(Trace* trace, uint quantity, ulong x, ulong y, ulong z)
{
    if (trace->count < trace->capacity) {
        global ulong* event = trace->events + TRACE_EVENT_WORDS * trace->count;
        event[0] = quantity;
        event[1] = x;
        event[2] = y;
        event[3] = z;
    }
    ++trace->count;
}

static inline void trace_choice(Trace* trace, uint quantity, uint x, uint y)
{
    trace->decisions = sampler_hash(trace->decisions + sampler_hash(x ^ sampler_hash(quantity + (y << 8))));
    trace_put(trace, quantity, x, y, 0ul);
}

static inline void trace_number(Trace* trace, uint quantity, real x)
{
    trace_put(trace, quantity, TRACE_BITS(x), 0ul, 0ul);
}

static inline void trace_vector(Trace* trace, uint quantity, real3 v)
{
    trace_put(trace, quantity, TRACE_BITS(v.x), TRACE_BITS(v.y), TRACE_BITS(v.z));
}

#define TRACE_CHOICE(scene, quantity, word) trace_choice((scene)->trace, quantity, word, 0u)
#define TRACE_CHOICES(scene, quantity, x, y) trace_choice((scene)->trace, quantity, x, y)
#define TRACE_NUMBER(scene, quantity, x) trace_number((scene)->trace, quantity, x)
#define TRACE_VECTOR(scene, quantity, v) trace_vector((scene)->trace, quantity, v)
#define TRACE_MEMBER(declaration) declaration;
#define TRACE_SET(place, value) (place) = (value)

#else

#define TRACE_CHOICE(scene, quantity, word)
#define TRACE_CHOICES(scene, quantity, x, y)
#define TRACE_NUMBER(scene, quantity, x)
#define TRACE_VECTOR(scene, quantity, v)
#define TRACE_MEMBER(declaration)
#define TRACE_SET(place, value)

#endif

#endif
