/* SPDX-License-Identifier: MIT
 * The integers of the model, for a parser that needs no compiler's headers.
 */
#ifndef EQUAL_STDINT_H
#define EQUAL_STDINT_H

typedef unsigned char uint8_t;
typedef unsigned short uint16_t;
typedef unsigned int uint32_t;
typedef unsigned long uint64_t;
typedef signed char int8_t;
typedef short int16_t;
typedef int int32_t;
typedef long int64_t;

#define UINT32_MAX 0xFFFFFFFFu
#define UINT64_MAX 0xFFFFFFFFFFFFFFFFul
#define UINT64_C(value) value##ul
#define UINT32_C(n) n##u
#define INT64_C(value) value##l

#endif
