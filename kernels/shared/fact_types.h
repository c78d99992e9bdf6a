// SPDX-License-Identifier: Apache-2.0
// What numerics/device_facts.cl asks a device: arrays of results, and rules that hold or not.
#ifndef CLRT_SHARED_FACT_TYPES_H
#define CLRT_SHARED_FACT_TYPES_H

/* Operands of each kind, eight a work-item. */
#define FACT_COUNT 4096
/* Terms of a sum. */
#define FACT_SUM_TERMS 64

/* Arrays of results, one behind the other. */
#define FACT_DIVISION 0
#define FACT_DIVISION_8 1 /* as vectors of eight, which some compilers divide in another way */
#define FACT_ROOT 2
#define FACT_ROOT_8 3
#define FACT_FMA 4
#define FACT_FMA_8 5
#define FACT_PRODUCT_SUM 6 /* a b + c, two roundings */
#define FACT_PRODUCT_DIFFERENCE 7 /* a b - c b, three roundings */
#define FACT_SUBNORMAL 8 /* a product below the normal numbers */
#define FACT_SUM 9 /* of FACT_SUM_TERMS numbers, in their order */
#define FACT_EXP 10
#define FACT_LOG 11
#define FACT_POW 12
#define FACT_ATAN2 13
#define FACT_ACOS 14
#define FACT_SIN_TURN 15
#define FACT_COS_TURN 16
#define FACT_ARRAYS 17

/* Bits of the rules that hold. */
#define FACT_RULE_NAN 1u        /* comparisons with NaN are false, fmin and fmax prefer numbers */
#define FACT_RULE_INFINITE 2u   /* dividing by zero gives infinity, infinity minus itself NaN */
#define FACT_RULE_ZERO 4u       /* -0 keeps its sign */
#define FACT_RULE_CONVERSION 8u /* to integers towards zero, from integers to nearest even */

#endif
