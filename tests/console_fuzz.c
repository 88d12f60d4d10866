/* SPDX-License-Identifier: MIT
 * Random lines for the console over the C model: console_fuzz SEED SECONDS. Every line must get exactly one
 * answer, immediately unless it is a move that waits for room; the sanitizers watch the rest. Prints how many
 * lines were answered ok and with an error, and how many of them waited.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fuzz.h"
#include "passo_engine.h"
#include "passo_terminal.h"

#define CLOCK_HZ 1000000u
#define ANSWER_MAX 8192u
#define LINES_PER_CONSOLE 400u

static const char *const WORDS[] = {"move", "turn", "rpm", "hold", "resume", "override", "stop", "abort",
    "clear", "status", "position", "angle", "enable", "disable", "zero", "sync", "start", "config", "table",
    "open", "version", "help", "input", "inputs", "home", "probe", "jog", "jog_speed", "jog_cancel",
    "trigger", "wait_trigger", "goto", "output", "outputs", "compare", "encoder", "encoders", "adopt",
    "thread", "bla", "steps", "profile", "total_time", "ramp_time", "start_speed", "speed", "stop_speed",
    "acceleration", "deceleration", "jerk", "method", "axis", "axes", "steps_per_turn", "rpm", "top_rpm",
    "minimum_rpm", "backward", "distance", "feed", "steps_per_mm", "accelerate_time", "decelerate_time",
    "alpha", "row", "points", "percent", "step_high", "step_low", "dir_setup", "dir_hold", "both_edges",
    "steps_per_unit", "clock_hz", "hold_time", "stop_time", "flow", "need_enable", "baud", "spi_slow", "on",
    "command", "channel", "channel", "limit_low", "limit_high", "home", "alarm", "limit_soft",
    "alarm_disables", "clear", "source", "edge", "action", "timeout", "back_off", "pull_off", "slow_speed",
    "position", "away", "optional", "input_filter", "watchdog", "watchdog_disable", "target", "late",
    "levels", "pwm", "lag", "reference", "output.levels", "output.power", "output.speed", "output.raster",
    "output.pitch", "output.x", "interval", "width", "filter", "counts_per_step", "limit", "stop", "inverted",
    "index_gated", "encoder", "counts_per_turn", "turns", "wait_index", "endless"};

#define COMMANDS 40u /* the first words; the last of them is none */

static const char *const VALUES[] = {"0", "1", "-1", "5", "50", "100", "3.5", "0.01", "1e-3", "2us",
    "7clocks", "10ms", "wait", "refuse", "200,-100", "1,2,3,4", "1,2,3,4,5,6,7,8,9", "20_000", "1e9",
    "4294967295", "4294967296", "1e99", "0.00000000000000000000000000000001", "linear", "cosine", "sigmoid",
    "jerk", "user", "in_time", "by_speed", "below_speed", "at_speed", "axes", "turn", "straight",
    "-2147483648", "2147483647", "1073741823", "-1073741824", "", ",", "1,,2", "x", "-", "1e",
    "0,100,200,300,400,500,600,700,800,900,1000,1100,1200,1300,1400,1500", "1600", "=", "#", "none",
    "active_high", "active_low", "home", "probe", "limit_low", "rising", "falling", "soft_stop",
    "end_endless", "soft", "hard", "0.25"};

#define LONG_MOVE "move steps=20 profile=linear total_time=0.05 ramp_time=10ms"

/* Valid lines, so that motions run in between. */
static const char *const LINES[] = {"move steps=20,-9 profile=cosine total_time=0.02 ramp_time=5ms",
    "move steps=30 profile=linear speed=2000 acceleration=30000",
    "turn steps_per_turn=200 rpm=60 acceleration=9999",
    "move method=sigmoid steps=9,4 speed=900 accelerate_time=0.01 alpha=3.25", "clear", "resume", "rpm 90",
    "rpm 0", "move method=jerk steps=15 speed=900 acceleration=30000 jerk=9e6",
    "config stop_time=1ms hold_time=1ms", "sync 1 channel=1", "start",
    "move steps=20,-9 profile=cosine total_time=0.02 ramp_time=5ms channel=1", "clear channel=1",
    "sync 0 channel=1",
    "move method=straight distance=1,2,3 feed=50 steps_per_mm=9 speed=90 acceleration=900 jerk=9000",
    "move method=turn steps_per_turn=200 angle=-45.5 rpm=120 acceleration=30000",
    "move steps=40 profile=linear speed=2000 acceleration=30000 output.levels=5 output.power=50",
    "move steps=40,5 profile=linear speed=2000 acceleration=30000 output.power=9 output.speed=3000",
    "move steps=40 profile=linear speed=2000 acceleration=30000 output.raster=255,0,99,1,255 output.pitch=4",
    "output pwm=1000 lag=20us reference=0.25", "output levels=3", "output reference=0.5",
    "compare axis=0 position=5 interval=3 width=20us", "encoder axis=0 counts_per_step=2 limit=30 stop=hard",
    "encoder axis=0 counts_per_step=4 limit=9 stop=soft", "encoder filter=9", "encoders", "adopt 0",
    "thread encoder=0 counts_per_turn=40 steps=20 turns=2 top_rpm=600 wait_index=0",
    "thread encoder=0 counts_per_turn=40 steps=-9 turns=1 top_rpm=600 endless=1"};

/* Now and then these lines, without pauses, so that a move has to wait for room. */
static const char *const FILL[] = {"abort", "clear", "resume", "sync 0", "config flow=wait need_enable=0",
    LONG_MOVE, LONG_MOVE, LONG_MOVE, LONG_MOVE, LONG_MOVE, LONG_MOVE};
#define FILLS (sizeof FILL / sizeof FILL[0])

struct bench {
	struct passo_engine *engine;
	unsigned long good, bad, waited;
	bool last; /* the last line was an answer */
	char said[ANSWER_MAX];
	size_t length;
};

/* Switches of some axes, a drive's alarm, e-stop; mostly all is well. Encoders are turned. */
static void poke(struct passo_engine *engine)
{
	static const enum passo_input PINS[] = {
	    PASSO_INPUT_HOME, PASSO_INPUT_LIMIT_LOW, PASSO_INPUT_PROBE, PASSO_INPUT_ALARM};

	if (below(16) == 0)
		passo_engine_set(engine, PICK(PINS), below(2));
	if (below(20) == 0)
		passo_engine_set(engine, PASSO_INPUT_ALARM, 0);
	for (uint32_t i = below(8); i > 0; i--) {
		passo_engine_set(engine, below(2) ? PASSO_INPUT_ENCODER_A : PASSO_INPUT_ENCODER_B, below(4));
		passo_engine_set(engine, PASSO_INPUT_ENCODER_INDEX, below(2));
		passo_engine_run(engine, 8);
	}
	passo_engine_set(engine, PASSO_INPUT_ESTOP_N, below(200) != 0);
}

static void drain(struct passo_engine *engine)
{
	struct passo_pin_event events[256];

	while (passo_engine_drain(engine, events, 256) == 256)
		continue;
}

/* Sometimes with bit errors. */
static bool transfer(void *context, const uint32_t *mosi, uint32_t *miso, size_t count)
{
	struct bench *bench = context;

	passo_engine_transfer(bench->engine, mosi, miso, count, 64 + 4 * count);
	if (below(200) == 0)
		miso[below((uint32_t)count)] ^= 1u << below(32);
	drain(bench->engine);
	return below(2000) != 0;
}

static bool irq(void *context)
{
	const struct bench *bench = context;

	return passo_engine_irq(bench->engine) != 0;
}

static uint32_t advance(void *context, uint32_t microseconds)
{
	struct bench *bench = context;
	uint64_t left = (uint64_t)microseconds * CLOCK_HZ / 1000000u;

	while (left) {
		left -= passo_engine_run(bench->engine, left);
		drain(bench->engine);
	}
	return (uint32_t)(passo_engine_clock(bench->engine) * 1000000u / CLOCK_HZ);
}

static void keep(void *context, const char *text)
{
	struct bench *bench = context;
	size_t length = strlen(text);

	if (bench->length + length >= ANSWER_MAX) {
		fprintf(stderr, "an answer is too long\n");
		exit(1);
	}
	memcpy(bench->said + bench->length, text, length + 1);
	bench->length += length;
}

/* Makes a line without its end, of any bytes except CR and LF. Returns its length. */
static size_t make_line(char *line)
{
	size_t length = 0;
	uint32_t kind = below(10);

	if (kind < 3) {
		length = (size_t)sprintf(line, "%s", PICK(LINES));
	} else {
		uint32_t words = below(8);

		length = (size_t)sprintf(line, "%s", kind < 9 ? WORDS[below(COMMANDS)] : "");
		for (uint32_t i = 0; i < words; i++)
			length += (size_t)sprintf(
			    line + length, below(8) ? " %s=%s" : " %s %s", PICK(WORDS), PICK(VALUES));
	}
	for (uint32_t i = below(12) ? 0 : 1 + below(3); i > 0 && length > 0; i--) {
		char byte = (char)below(256);

		if (byte != '\n' && byte != '\r')
			line[below((uint32_t)length)] = byte;
	}
	if (below(60) == 0) {
		memset(line + length, ' ' + (int)below(90), 300);
		length += 300;
	}
	return length;
}

/* Counts the answers, lines that begin with ok or error. Every line is one, a note or indented, and has an
 * end.
 */
static unsigned answers(struct bench *bench, const char *line)
{
	unsigned found = 0;

	for (const char *at = bench->said; *at;) {
		const char *end = strchr(at, '\n');
		const bool ok = strncmp(at, "ok", 2) == 0 && (at[2] == ' ' || at[2] == '\n');
		const bool error = strncmp(at, "error: ", 7) == 0;

		bench->good += ok;
		bench->bad += error;
		found += ok || error;
		bench->last = ok || error;
		if (!end || (!ok && !error && strncmp(at, "  ", 2) != 0 && strncmp(at, "note: ", 6) != 0)) {
			fprintf(stderr, "to \"%s\" it said: %s\n", line, bench->said);
			exit(1);
		}
		at = end + 1;
	}
	return found;
}

/* Takes what was said after `lines` lines, or while time passed: each line is answered, except the one that
 * may wait, and an answer is the last that is said to a line. Returns whether one waits. */
static bool check(
    struct bench *bench, const struct passo_terminal *terminal, unsigned lines, bool typed, const char *line)
{
	const bool waits = passo_terminal_owes(terminal);

	bench->last = true;
	if (answers(bench, line) + waits != lines || (typed && !bench->last)) {
		fprintf(stderr, "to \"%s\", the last of %u lines: %s\n", line, lines, bench->said);
		exit(1);
	}
	bench->length = 0;
	bench->said[0] = '\0';
	return waits;
}

int main(int count, char **arguments)
{
	static struct bench bench;
	static char line[8192];

	fuzz_begin(count, arguments);
	while (fuzz_goes_on()) {
		const struct passo_engine_config config = {.core = {.channels = below(4) == 0 ? 2u : 1u,
							       .axes = (uint8_t)(1u + below(8)),
							       .tick_log2 = 7,
							       .line_queue_log2 = 4,
							       .ramp_queue_log2 = 4,
							       .inputs = (uint8_t)below(2),
							       .encoders = (uint8_t)below(2),
							       .outputs = (uint8_t)below(2)},
		    .clock_hz = CLOCK_HZ,
		    .spi_half_period = 2};
		struct passo_terminal *terminal;
		bool waits = false;

		bench.length = 0;
		bench.engine = passo_engine_create(&config);
		terminal = passo_terminal_create(
		    &(struct passo_terminal_caller){transfer, advance, irq, keep, &bench}, CLOCK_HZ);
		bench.length = 0; /* the greeting */
		bench.said[0] = '\0';
		for (unsigned i = 0, fill = FILLS; i < LINES_PER_CONSOLE; i++, fill++) {
			size_t length;

			if (fill >= FILLS && below(40) == 0)
				fill = 0;
			length = fill < FILLS ? (size_t)sprintf(line, "%s", FILL[fill]) : make_line(line);

			poke(bench.engine);
			passo_terminal_type(terminal, line, length);
			if (bench.length != 0) {
				fprintf(stderr, "an answer before the end of the line: %s\n", bench.said);
				return 1;
			}
			passo_terminal_type(terminal, "\n", 1);
			waits = check(&bench, terminal, 1u + waits, true, line);
			bench.waited += waits;
			for (uint32_t round = fill < FILLS ? 0 : below(4); round > 0; round--) {
				passo_terminal_poll(terminal);
				advance(&bench, below(4) ? below(400) : below(8000));
			}
			waits = check(&bench, terminal, waits, false, line);
		}
		passo_terminal_destroy(terminal);
		passo_engine_destroy(bench.engine);
	}
	printf("ok %lu\nerror %lu\nwaited %lu\n", bench.good, bench.bad, bench.waited);
	return 0;
}
