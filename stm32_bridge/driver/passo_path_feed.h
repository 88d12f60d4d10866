/* SPDX-License-Identifier: MIT
 * Feeds a path (c_model/planner/passo_path.h) to a channel of the core, line by line.
 *
 *     passo_path_feed_open(&feed, &passo, &path);
 *     for (;;) {
 *             if (there is a line and passo_path_room(&path) > 0 and not passo_path_feed_is_urgent(&feed))
 *                     passo_path_add(&path, &line);
 *             error = passo_path_feed_poll(&feed); // instead of passo_poll()
 *     }
 * The core moves while lines are available; if the source stalls, the path decelerates to rest at the end of
 * the last line. Each rest ends a motion. Hold, resume and override are those of passo.h. After a
 * stop and passo_clear() call passo_path_restart() with the positions and passo_path_feed_open(), to drop the
 * rest of the path, or passo_path_feed_recover() to continue it.
 */
#ifndef PASSO_PATH_FEED_H
#define PASSO_PATH_FEED_H

#ifdef __cplusplus
extern "C" {
#endif

#include "passo.h"
#include "passo_path.h"

#define PASSO_PATH_FEED_RAMPS 32u /* that are remembered */

/* All members are private. */
struct passo_path_feed {
	struct passo *passo;
	struct passo_path_planner *path;
	uint64_t left;                         /* clocks of ramps that the core holds, lower bound */
	uint32_t at;                           /* microseconds: time of `left` */
	uint32_t seen;                         /* time of the last status read that corrected it */
	uint32_t rate;                         /* highest rate since then, UQ1.16 */
	uint32_t ticks[PASSO_PATH_FEED_RAMPS]; /* of the ramps sent last */
	uint32_t ramps, lines;                 /* sent, of this motion */
	uint32_t first, done;                  /* number of its first line; lines executed, at least */
	uint32_t moving;                       /* number of the current line, as of the last status read */
	uint32_t added, added_at;              /* known lines, and when the last was added */
	bool hurry;                            /* start with the known lines */
	uint32_t given;                        /* lines and ramps sent before this poll */
	bool gave;                             /* the last poll sent lines or ramps */
};

/* Connects a path to an open channel; the planner learns how fast it can be sent. All three must stay valid.
 * No frame. */
void passo_path_feed_open(struct passo_path_feed *feed, struct passo *passo, struct passo_path_planner *path);

/* Calls passo_poll() and starts motions. A motion starts when the look-ahead is full, when the path has been
 * ended, or when no line was added for 20 ms. Errors: those of passo_stream() and passo_poll(). */
enum passo_error passo_path_feed_poll(struct passo_path_feed *feed);

/* Whether the core may run out of ramps within this time unless more are sent, by the lower bound of what it
 * holds. */
bool passo_path_feed_is_short(const struct passo_path_feed *feed, uint32_t microseconds);

/* Whether the next poll is urgent: the core is short of ramps, and the last poll sent some. The caller must
 * then not add lines first, so that a burst of them cannot starve the core. */
bool passo_path_feed_is_urgent(const struct passo_path_feed *feed);

/* After a stop and passo_clear(): continues the rest of the path from the current positions, immediately.
 * False: the line on which it stopped is no longer in memory. */
bool passo_path_feed_recover(struct passo_path_feed *feed, const int32_t *positions);

/* True until all lines have been executed, as of the last poll. */
bool passo_path_feed_is_moving(const struct passo_path_feed *feed);

#ifdef __cplusplus
}
#endif

#endif
