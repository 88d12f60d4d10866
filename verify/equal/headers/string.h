/* SPDX-License-Identifier: MIT */
#ifndef EQUAL_STRING_H
#define EQUAL_STRING_H

typedef unsigned long size_t;

void *memset(void *to, int value, size_t size);
void *memcpy(void *to, const void *from, size_t size);
int memcmp(const void *a, const void *b, size_t size);

#endif
