/* SPDX-License-Identifier: MIT
 * What runs: an image has the console, or grbl, or both (PASSO_BOTH). Of both one runs, grbl from power-on; a
 * line changes to the other by a reset.
 */
#ifndef IMAGE_H
#define IMAGE_H

#include <stdbool.h>

#ifdef PASSO_BOTH

/* Variables that only one of them needs: the other has its own in their place. */
#define ONLY_CONSOLE __attribute__((section(".bss.only_console")))
#define ONLY_GRBL __attribute__((section(".bss.only_grbl")))

/* What begins with the next reset, and after every other one until the power is removed; or when the line
 * that says so has been answered. */
void image_choose_console(void);
void image_choose_grbl(void);

/* In the main loop: resets once the answer has left. */
void image_mind_choice(void);

#else

#define ONLY_CONSOLE
#define ONLY_GRBL

static inline void image_mind_choice(void)
{
}

#endif
#endif
