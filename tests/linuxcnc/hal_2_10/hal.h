/* SPDX-License-Identifier: MIT
 * What the component uses of HAL as LinuxCNC 2.10 has it, for a compile without that: pins and parameters are
 * opaque.
 */
#ifndef HAL_H
#define HAL_H

#include <stdbool.h>
#include <stdint.h>

#ifndef HAL_API_BEFORE_ITS_VERSION /* which names no version: HAL_BOOL tells */
#define HAL_API_VERSION 1
#endif
#define HAL_NAME_LEN 55

typedef enum { HAL_IN = 16, HAL_OUT = 32, HAL_IO = 48, HAL_RW = 192 } hal_pdir_t;
typedef struct hal_opaque_bool *hal_bool_t;
typedef struct hal_opaque_sint *hal_sint_t;
typedef struct hal_opaque_uint *hal_uint_t;
typedef struct hal_opaque_real *hal_real_t;

#define HAL_ACCESS(kind, reference, type)                                                                    \
	type hal_get_##kind(const reference);                                                                \
	type hal_set_##kind(reference, type);                                                                \
	int hal_pin_new_##kind(int, hal_pdir_t, reference *, type, const char *, ...)                        \
	    __attribute__((format(printf, 5, 6)));                                                           \
	int hal_param_new_##kind(int, hal_pdir_t, reference *, type, const char *, ...)                      \
	    __attribute__((format(printf, 5, 6)));
HAL_ACCESS(bool, hal_bool_t, bool)
HAL_ACCESS(si32, hal_sint_t, int32_t)
HAL_ACCESS(ui32, hal_uint_t, uint32_t)
HAL_ACCESS(real, hal_real_t, double)

int hal_init(const char *);
int hal_exit(int);
int hal_ready(int);
void *hal_malloc(long);
int hal_export_funct(const char *, void (*)(void *, long), void *, int, int, int);

#endif
