/* SPDX-License-Identifier: MIT
 * When a host whose polls only read the state can skip them; see passo_engine_pass_looks().
 */
#ifndef PASSO_RESTS_H
#define PASSO_RESTS_H

#include "passo_program.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Whether polls would only read the state until that has changed. */
bool passo_feed_rests(const struct passo_path_feed *feed);
bool passo_program_rests(const struct passo_program *program);

#ifdef __cplusplus
}
#endif

#endif
