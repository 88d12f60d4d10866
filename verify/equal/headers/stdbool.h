/* SPDX-License-Identifier: MIT */
#ifndef EQUAL_STDBOOL_H
#define EQUAL_STDBOOL_H

#define bool _Bool
#define true 1
#define false 0

#endif
