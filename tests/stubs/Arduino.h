/* SPDX-License-Identifier: MIT
 * Declares what the Arduino example uses, so that it can be compiled here.
 */
#pragma once
#include <stdint.h>

enum { LOW, HIGH };
enum { INPUT, OUTPUT };
enum { PA4 = 4 };

void pinMode(uint32_t pin, uint32_t mode);
void digitalWrite(uint32_t pin, uint32_t level);
unsigned long micros();
