/* SPDX-License-Identifier: MIT
 * The time buffered in the core: each ramp adds to it, and it elapses at the rate of the time scale. The
 * clocks of host and core differ, so each status read corrects it: at least the ramps after the current one
 * are left, and at most those including it.
 */
#include "passo_path_feed.h"

#include "passo_driver.h"
#include "passo_math.h"

#define START_MICROSECONDS 20000u
#define START_LINES 16u /* that may be over within one poll */
#define MICROSECONDS_PER_SECOND 1000000u
#define BATCH_MICROSECONDS 300u
#define SHORT_MICROSECONDS 2000u /* several times what a line takes to be read and planned */

static uint32_t tick_log2(const struct passo_path_feed *feed)
{
	return feed->passo->machine.tick_log2;
}

static uint32_t larger(uint32_t a, uint32_t b)
{
	return a > b ? a : b;
}

static uint32_t smaller(uint32_t a, uint32_t b)
{
	return a < b ? a : b;
}

static bool give_line(void *context, struct passo_line *line)
{
	struct passo_path_feed *feed = context;
	const bool given = passo_path_next_line(feed->path, line);

	feed->lines += given;
	return given;
}

/* The ramps of this poll take long to compute: send the available ones first. */
static bool is_late(const struct passo_path_feed *feed)
{
	return feed->passo->stream == PASSO_STREAM_RUNS && feed->ramps + feed->lines != feed->given
	    && passo_driver_now(feed->passo) - feed->at > BATCH_MICROSECONDS;
}

/* Before the motion starts, lines make room for others, before ramps come down for the last one known: those
 * of a look-ahead, or a few if the ramps last for the reserve. */
static bool can_send_lines(const struct passo_path_feed *feed)
{
	const struct passo *passo = feed->passo;
	const struct passo_path_planner *path = feed->path;
	const bool lasts = feed->left >> tick_log2(feed) >= path->reserve;

	return passo->stream == PASSO_STREAM_FILLS && passo->lines != PASSO_SUPPLY_DONE
	    && passo->snapshot.line_room > 0u && path->sent + 1u < path->added
	    && feed->lines < (lasts ? smaller(path->capacity, START_LINES) : path->capacity);
}

static bool give_ramp(void *context, struct passo_ramp *ramp)
{
	struct passo_path_feed *feed = context;
	const bool waits =
	    feed->passo->stream == PASSO_STREAM_FILLS && (!feed->hurry || can_send_lines(feed));
	const uint64_t left = feed->left >> tick_log2(feed);
	const uint32_t held = waits || left > UINT32_MAX ? UINT32_MAX : (uint32_t)left;

	if (is_late(feed) || !passo_path_next_ramp(feed->path, held, ramp))
		return false;
	feed->ticks[feed->ramps++ % PASSO_PATH_FEED_RAMPS] = ramp->ticks;
	feed->left += (uint64_t)ramp->ticks << tick_log2(feed);
	return true;
}

/* The rate of the core: current or target. */
static uint32_t rate(const struct passo_path_feed *feed)
{
	return larger(passo_driver_rate(feed->passo), feed->passo->snapshot.rate);
}

/* Clocks of the last `count` ramps sent. */
static uint64_t clocks_of(const struct passo_path_feed *feed, uint32_t count)
{
	uint64_t ticks = 0;

	for (uint32_t i = 0; i < count && i < PASSO_PATH_FEED_RAMPS && i < feed->ramps; i++)
		ticks += feed->ticks[(feed->ramps - 1u - i) % PASSO_PATH_FEED_RAMPS];
	return ticks << tick_log2(feed);
}

static void pass_time(struct passo_path_feed *feed)
{
	const struct passo *passo = feed->passo;
	const uint32_t now = passo_driver_now(passo), present = rate(feed);
	const uint64_t passed = (uint64_t)(now - feed->at) * larger(feed->rate, present);
	const uint64_t clocks = passo_mul_div_ceil(
	    passed, passo->machine.clock_hz, (uint64_t)MICROSECONDS_PER_SECOND * PASSO_RATE_FULL);

	feed->at = now;
	feed->rate = present;
	if (passo->stream != PASSO_STREAM_FILLS)
		feed->left -= feed->left < clocks ? feed->left : clocks;
}

/* After a status read. */
static void correct(struct passo_path_feed *feed)
{
	const struct passo *passo = feed->passo;
	const uint32_t queued = (uint32_t)(passo->ramp_places - passo->snapshot.ramp_room);

	if (feed->seen == passo->looked_at || passo_driver_is_sending(passo)
	    || passo->stream == PASSO_STREAM_FILLS)
		return;
	feed->seen = passo->looked_at;
	const uint32_t waiting =
	    (uint32_t)(passo->line_places - passo->snapshot.line_room); /* including the current one */
	const uint32_t lines = waiting + 1u;
	if (passo->snapshot.state == PASSO_STATE_RUN && waiting > 0u)
		feed->moving = feed->first + feed->lines - waiting;
	if (passo->snapshot.state == PASSO_STATE_RUN && feed->lines > lines)
		feed->done = feed->first + feed->lines - lines;
	const uint64_t least = queued > 1u ? clocks_of(feed, queued - 1u) : 0u;
	const uint64_t most = clocks_of(feed, queued);

	if (feed->left > most && queued < PASSO_PATH_FEED_RAMPS)
		feed->left = most;
	if (feed->left < least)
		feed->left = least;
}

static void set_pace(const struct passo *passo, struct passo_path_planner *path)
{
	const uint32_t ramps = smaller(PASSO_FRAME_PAYLOAD_MAX / PASSO_RAMP_WORDS, passo->ramp_places / 2u);
	const uint32_t words = passo->host->line_words;

	if (words == 0u)
		return;
	const uint32_t lines = smaller(PASSO_FRAME_PAYLOAD_MAX / words, passo->line_places / 2u);
	passo_path_pace(path, smaller(passo->ramp_places - ramps, ramps), passo->line_places - lines, lines);
}

void passo_path_feed_open(struct passo_path_feed *feed, struct passo *passo, struct passo_path_planner *path)
{
	set_pace(passo, path);
	*feed = (struct passo_path_feed){
	    .passo = passo, .path = path, .at = passo_driver_now(passo), .rate = PASSO_RATE_FULL};
}

static enum passo_error begin(struct passo_path_feed *feed)
{
	const struct passo_source source = {.line = give_line, .ramp = give_ramp, .context = feed};

	passo_path_next_motion(feed->path);
	feed->left = 0;
	feed->first = feed->done = feed->moving = feed->path->sent;
	feed->ramps = feed->lines = 0;
	feed->hurry = false;
	return passo_stream(feed->passo, &source);
}

/* Whether the stream starts with the items it has: not with a jump alone, before the next item was requested,
 * nor while lines can be sent. */
static bool is_time(struct passo_path_feed *feed)
{
	const uint32_t now = passo_driver_now(feed->passo);

	if (feed->added != feed->path->added) {
		feed->added = feed->path->added;
		feed->added_at = now;
	}
	const bool hurried = feed->hurry;

	feed->hurry = passo_path_room(feed->path) == 0u || now - feed->added_at >= START_MICROSECONDS;
	return feed->hurry && (hurried || feed->left > 0u) && feed->ramps > 0u && feed->lines > 0u
	    && !can_send_lines(feed);
}

enum passo_error passo_path_feed_poll(struct passo_path_feed *feed)
{
	struct passo *passo = feed->passo;
	enum passo_error error = PASSO_OK;

	pass_time(feed);
	feed->given = feed->ramps + feed->lines;
	if (!passo_is_moving(passo) && feed->path->sent != feed->path->added)
		error = begin(feed);
	else if (passo->stream == PASSO_STREAM_FILLS && is_time(feed) && !passo_driver_is_sending(passo))
		error = passo_stream_start(passo);
	if (error == PASSO_OK)
		error = passo_poll(passo);
	correct(feed);
	feed->gave = feed->ramps + feed->lines != feed->given || passo->post == PASSO_POST_ITEMS;
	return error;
}

bool passo_path_feed_is_short(const struct passo_path_feed *feed, uint32_t microseconds)
{
	const struct passo *passo = feed->passo;

	return passo->stream == PASSO_STREAM_RUNS && feed->left < passo_clocks(passo, microseconds);
}

bool passo_path_feed_is_urgent(const struct passo_path_feed *feed)
{
	return feed->gave && passo_path_feed_is_short(feed, SHORT_MICROSECONDS);
}

bool passo_path_feed_recover(struct passo_path_feed *feed, const int32_t *positions)
{
	return passo_path_recover(feed->path, positions, feed->done);
}

bool passo_path_feed_is_moving(const struct passo_path_feed *feed)
{
	return passo_is_moving(feed->passo) || feed->path->sent != feed->path->added;
}
