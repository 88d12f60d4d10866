/* SPDX-License-Identifier: MIT
 * Pins and parameters of HAL, whose interface LinuxCNC 2.10 has changed: behind them there are functions, and
 * parameters are no variables of the component any more. GET() and SET() take pins and parameters of any
 * type.
 */
#ifndef PASSO_HAL_H
#define PASSO_HAL_H

#include <stdarg.h>
#include <stdio.h>

#include "hal.h"

/* What LinuxCNC 2.10 has and 2.9 has not. */
#if defined HAL_API_VERSION || defined HAL_BOOL

typedef hal_bool_t hal_bit;
typedef hal_real_t hal_float;
typedef hal_sint_t hal_s32;
typedef hal_uint_t hal_u32;
#define GET(pin)                                                                                             \
	_Generic((pin),                                                                                      \
	    hal_bool_t: hal_get_bool,                                                                        \
	    hal_real_t: hal_get_real,                                                                        \
	    hal_sint_t: hal_get_si32,                                                                        \
	    hal_uint_t: hal_get_ui32)(pin)
#define SET(pin, value)                                                                                      \
	_Generic((pin),                                                                                      \
	    hal_bool_t: hal_set_bool,                                                                        \
	    hal_real_t: hal_set_real,                                                                        \
	    hal_sint_t: hal_set_si32,                                                                        \
	    hal_uint_t: hal_set_ui32)(pin, value)
#define PASSO_HAL_NEW(kind, type)                                                                            \
	static int new_##kind##_named(                                                                       \
	    int component, hal_pdir_t direction, hal_##kind *pin, double value, const char *name)            \
	{                                                                                                    \
		return direction == HAL_RW                                                                   \
		         ? hal_param_new_##type(component, direction, pin, value, "%s", name)                \
		         : hal_pin_new_##type(component, direction, pin, value, "%s", name);                 \
	}

#else

typedef hal_bit_t *hal_bit;
typedef hal_float_t *hal_float;
typedef hal_s32_t *hal_s32;
typedef hal_u32_t *hal_u32;
typedef int hal_pdir_t;
#define GET(pin) (*(pin))
#define SET(pin, value) (*(pin) = (value))
#define PASSO_HAL_NEW(kind, type)                                                                            \
	static int new_##kind##_named(                                                                       \
	    int component, hal_pdir_t direction, hal_##kind *pin, double value, const char *name)            \
	{                                                                                                    \
		int error = -1;                                                                              \
                                                                                                             \
		if (direction != HAL_RW)                                                                     \
			error = hal_pin_##kind##_new(name, (hal_pin_dir_t)direction, pin, component);        \
		else if ((*pin = hal_malloc(sizeof **pin)) != NULL)                                          \
			error = hal_param_##kind##_new(name, HAL_RW, *pin, component);                       \
		if (error == 0)                                                                              \
			SET(*pin, value);                                                                    \
		return error;                                                                                \
	}

#endif

PASSO_HAL_NEW(bit, bool)
PASSO_HAL_NEW(float, real)
PASSO_HAL_NEW(s32, si32)
PASSO_HAL_NEW(u32, ui32)

/* A pin, or with HAL_RW a parameter, with its first value; 0, or an error of HAL. */
#define PASSO_HAL_NAMED(kind)                                                                                \
	__attribute__((format(printf, 5, 6))) static int new_##kind(                                         \
	    int component, hal_pdir_t direction, hal_##kind *pin, double value, const char *format, ...)     \
	{                                                                                                    \
		char name[HAL_NAME_LEN + 1];                                                                 \
		va_list arguments;                                                                           \
                                                                                                             \
		va_start(arguments, format);                                                                 \
		vsnprintf(name, sizeof name, format, arguments);                                             \
		va_end(arguments);                                                                           \
		return new_##kind##_named(component, direction, pin, value, name);                           \
	}
PASSO_HAL_NAMED(bit)
PASSO_HAL_NAMED(float)
PASSO_HAL_NAMED(s32)
PASSO_HAL_NAMED(u32)

#endif
