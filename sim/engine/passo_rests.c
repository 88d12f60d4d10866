/* SPDX-License-Identifier: MIT
 * Whether the driver has nothing to send.
 */
#include "passo_rests.h"

bool passo_feed_rests(const struct passo_path_feed *feed)
{
	const struct passo *passo = feed->passo;
	const bool runs = passo->stream == PASSO_STREAM_RUNS;
	const bool ends = passo->stream == PASSO_STREAM_NONE && passo->expects != PASSO_EXPECT_NOTHING;

	/* a dry source may have ramps when the core is short of them */
	return (runs || ends) && !feed->gave && passo->ramps != PASSO_SUPPLY_DRY
	    && passo->task.kind == PASSO_TASK_NONE && passo_idle_time(passo) > 0u;
}

bool passo_program_rests(const struct passo_program *program)
{
	const struct passo_player *player = &program->player;
	const bool line = player->action.kind == PASSO_GCODE_LINE;
	const bool waits = player->waits && !(line && passo_path_room(&program->path) > 0u);
	const bool ended = program->ends && passo_player_is_ready(player);

	return (waits || ended) && passo_feed_rests(&program->feed);
}
