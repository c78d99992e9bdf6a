// SPDX-License-Identifier: Apache-2.0
// What differs between compilers, in one place: each entry says which one wants it and why.
#ifndef CLRT_NUMERICS_DEVICE_H
#define CLRT_NUMERICS_DEVICE_H

/* Clang for x86: warns where a vector that is wider than the processor's registers (double8 without AVX-512,
   float8 and double3 without AVX) crosses a function's border, for the calling convention depends on the
   instruction set. That is a danger to code whose parts are compiled apart. A program and its driver's
   functions are compiled for one instruction set and linked as a whole, and OpenCL C's own functions (fma,
   vload8) take such vectors too. */
#if defined(__clang__) && defined(__has_warning)
#if __has_warning("-Wpsabi")
#pragma clang diagnostic ignored "-Wpsabi"
#endif
#endif

/* PoCL compiles a kernel's body several times (kernel, work-group launchers), but a function once; other CPU
   and NVIDIA compilers shorten their build alike. So every large function is kept out of line. */
#define CLRT_NOINLINE __attribute__((noinline))

/* A body that two functions share, told apart by a constant argument: nothing of the choice is left in
   either. Clang for NVIDIA's targets would call it instead. */
#define CLRT_INLINE static inline __attribute__((always_inline))

/* Begins an entry point. Intel's CPU runtime runs several work-items in the lanes of vectors and takes apart
   the vectors that the code is written in: small kernels around eight-wide traversal become three to six
   times slower, large ones compile for 12 to 19 seconds before it gives up. The hint keeps the code as
   written. */
#ifdef cl_intel_vec_len_hint
#define CLRT_KERNEL kernel __attribute__((intel_vec_len_hint(1)))
#else
#define CLRT_KERNEL kernel
#endif

/* Samples of a pixel that are simulated side by side: 1, or a multiple of DEVICE_LANES. Their arithmetic does
   not depend on each other, so a processor that works ahead fills the waits of one with the others, and what
   all of them do alike is done in the lanes of vectors. The host sets 1 for devices that have many work-items
   in flight instead. No sample's radiance depends on it. */
#ifndef SAMPLES_AT_ONCE
#define SAMPLES_AT_ONCE 32
#endif

/* Iterations of a loop that compilers for CPUs turn into one, with vectors: as many as AVX2 has lanes. */
#define DEVICE_LANES (SAMPLES_AT_ONCE < 8 ? SAMPLES_AT_ONCE : 8)

#ifndef __has_builtin
#define __has_builtin(x) 0
#endif

/* x86 targets of PoCL: vmovmskps gathers eight sign bits in one instruction. Elsewhere, and for double, four
   portable scalar operations. */
#if __has_builtin(__builtin_ia32_movmskps256) && !defined(REAL_IS_DOUBLE)
#define CLRT_HAS_MOVMSKPS 1
#endif

/* A large function that gives a struct to one caller that matters. x86 targets of PoCL: in line, so that of
   the struct only what that caller reads is computed and nothing goes through memory. Elsewhere out of line
   like all large functions; Oclgrind 21.10 does not even know the intrinsic that clang writes where it puts a
   returned struct, or a `restrict` parameter, in line. */
#ifdef CLRT_HAS_MOVMSKPS
#define CLRT_GIVES_STRUCT CLRT_INLINE
#else
#define CLRT_GIVES_STRUCT static CLRT_NOINLINE
#endif

/* x86 targets of PoCL: LLVM's own bit reversal is the fastest. Elsewhere it is written out, with ^ instead of
   |, because Oclgrind 21.10 does not know the intrinsic that LLVM would make of it. */
#if __has_builtin(__builtin_bitreverse32) && defined(CLRT_HAS_MOVMSKPS)
#define CLRT_REVERSE_BITS(x) __builtin_bitreverse32(x)
#endif

/* x86 targets of PoCL: tzcnt, one instruction. Elsewhere count from the other end: OpenCL C has clz since
   1.0, ctz since 2.0, and Oclgrind 21.10 does not know the intrinsic behind the builtin. */
#if __has_builtin(__builtin_ctz) && defined(CLRT_HAS_MOVMSKPS)
#define CLRT_LOWEST_BIT(x) ((uint)__builtin_ctz(x))
#else
#define CLRT_LOWEST_BIT(x) (31u - clz((x) & -(x)))
#endif

/* Clang-based compilers for CPUs: start loading a node that will be visited soon. */
#if __has_builtin(__builtin_prefetch) && defined(CLRT_HAS_MOVMSKPS)
#define CLRT_PREFETCH(pointer) __builtin_prefetch((const void*)(ulong)(pointer))
#else
#define CLRT_PREFETCH(pointer) ((void)(pointer))
#endif

#endif
