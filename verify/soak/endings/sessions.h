/* SPDX-License-Identifier: MIT
 * The host fails, another one opens; docs/driver.md has the table of what it finds and does.
 */
#ifndef SOAK_ENDINGS_SESSIONS_H
#define SOAK_ENDINGS_SESSIONS_H

#include "endings.h"

/* False if something of the first session acted in the second. */
bool session_play(struct bench *bench, uint32_t seed, struct scene *scene);

#endif
