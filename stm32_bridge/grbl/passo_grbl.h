/* SPDX-License-Identifier: MIT
 * The serial protocol of grbl 1.1: lines with their answers, real-time bytes, status reports.
 *
 *     passo_grbl_open(&grbl, &player, &sink);
 *     passo_grbl_receive(&grbl, byte); // each byte from the host, also from an interrupt
 *     passo_grbl_poll(&grbl);          // in the main loop; does not wait
 */
#ifndef PASSO_GRBL_H
#define PASSO_GRBL_H

#include "passo_gcode_line.h"
#include "passo_player.h"

/* Bytes from the host that wait, at most one less; senders that count characters need at least 128. */
#define PASSO_GRBL_RECEIVED 256u

/* Where answers go. */
struct passo_grbl_sink {
	void (*write)(void *context, const char *text);
	void *context;
};

enum passo_grbl_alarm {
	PASSO_GRBL_NO_ALARM,
	PASSO_GRBL_HARD_LIMIT,
	PASSO_GRBL_SOFT_LIMIT,
	PASSO_GRBL_ABORTED,
	PASSO_GRBL_PROBE_LEVEL,
	PASSO_GRBL_PROBE_MISSED
};

/* All members are private. */
struct passo_grbl {
	struct passo_player *player;
	struct passo_grbl_sink sink;
	struct passo_gcode_line line;
	char received[PASSO_GRBL_RECEIVED];
	volatile uint8_t head, tail; /* of the ring: next to be written, next to be read */
	volatile bool asks, holds, resumes, resets, cancels, lost;
	volatile uint8_t feed_change; /* the real-time byte; 0: none */
	uint8_t feed_percent;
	uint8_t reports; /* until the next one with offsets */
	enum passo_grbl_alarm alarm;
	bool held, jogs, checks;
	bool stopping, greets; /* a soft stop is under way; the greeting follows it */
};

/* The player is open. Writes the greeting. */
void passo_grbl_open(
    struct passo_grbl *grbl, struct passo_player *player, const struct passo_grbl_sink *sink);
void passo_grbl_receive(struct passo_grbl *grbl, char byte);
void passo_grbl_poll(struct passo_grbl *grbl);

/* Nothing moves or waits. */
bool passo_grbl_is_idle(const struct passo_grbl *grbl);

/* Internal: shared by the sources of the protocol. */
void passo_grbl_say(struct passo_grbl *grbl, const char *text);
void passo_grbl_say_number(struct passo_grbl *grbl, uint64_t number);
void passo_grbl_say_millimetres(struct passo_grbl *grbl, int64_t nanometres);
void passo_grbl_report(struct passo_grbl *grbl);
void passo_grbl_report_modes(struct passo_grbl *grbl);
void passo_grbl_report_offsets(struct passo_grbl *grbl);
/* A line that begins with `$`. */
enum passo_gcode_error passo_grbl_system(struct passo_grbl *grbl, const char *text);

#endif
