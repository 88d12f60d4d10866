/* SPDX-License-Identifier: MIT */
#ifndef EQUAL_STDDEF_H
#define EQUAL_STDDEF_H

typedef unsigned long size_t;

#endif
