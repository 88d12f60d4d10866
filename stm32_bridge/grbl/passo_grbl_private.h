/* SPDX-License-Identifier: MIT
 * Internal: shared by the sources of the protocol.
 */
#ifndef PASSO_GRBL_PRIVATE_H
#define PASSO_GRBL_PRIVATE_H

#include "passo_grbl.h"

void passo_grbl_say(struct passo_grbl *grbl, const char *text);
void passo_grbl_say_number(struct passo_grbl *grbl, uint64_t number);
/* Millionths, with three decimals. */
void passo_grbl_say_thousandths(struct passo_grbl *grbl, int64_t millionths);
/* In the units of reports: lengths in nanometres. */
void passo_grbl_say_length(struct passo_grbl *grbl, int64_t nanometres);
void passo_grbl_say_position(struct passo_grbl *grbl, const char *name, const int64_t *position);
void passo_grbl_say_rate(struct passo_grbl *grbl, uint64_t rate); /* mm/min, UQ48.16 */
void passo_grbl_report(struct passo_grbl *grbl);
void passo_grbl_report_modes(struct passo_grbl *grbl);
void passo_grbl_report_offsets(struct passo_grbl *grbl);
void passo_grbl_report_probe(struct passo_grbl *grbl);
void passo_grbl_report_settings(struct passo_grbl *grbl);
void passo_grbl_report_starts(struct passo_grbl *grbl);
void passo_grbl_answer(struct passo_grbl *grbl, enum passo_gcode_error error);
void passo_grbl_greet(struct passo_grbl *grbl);

enum passo_grbl_state passo_grbl_state(const struct passo_grbl *grbl);

/* A reset, as soon as the requests are served; overrides are 100 % from here on. */
void passo_grbl_ask_reset(struct passo_grbl *grbl);
/* Serves the real-time requests. */
void passo_grbl_obey(struct passo_grbl *grbl);
/* The next byte of the lines; false: there is none. */
bool passo_grbl_next(struct passo_grbl *grbl, char *byte);
/* Once all has been read: number of lines that were lost with their ends. */
unsigned passo_grbl_lost(struct passo_grbl *grbl);
/* All that has come in. */
void passo_grbl_drop_input(struct passo_grbl *grbl);
/* Jogs that have been received before a request to cancel are not made. */
void passo_grbl_drop_jogs(struct passo_grbl *grbl);

/* Tells an alarm, answers the line under way, and stops. */
void passo_grbl_fail(struct passo_grbl *grbl, enum passo_grbl_alarm alarm, enum passo_gcode_error error);
void passo_grbl_begin_stop(struct passo_grbl *grbl);
/* Once the machine rests: the program goes on from where it is. Returns whether something has been said. */
bool passo_grbl_end_stop(struct passo_grbl *grbl);
/* It comes to rest. */
bool passo_grbl_slows(const struct passo_grbl *grbl);
/* The overrides of feed, rapids and spindle are in force. */
void passo_grbl_override(struct passo_grbl *grbl);
/* So is the rate of the core. */
void passo_grbl_mind_rate(struct passo_grbl *grbl);
/* Drives on or off; at rest. */
enum passo_error passo_grbl_drive(struct passo_grbl *grbl, bool on);
/* Drives that rest are switched off after the time of the settings. */
void passo_grbl_mind_drives(struct passo_grbl *grbl);

/* Makes path, interpreter, pins and inputs those of the settings. At rest; the path begins anew. Errors:
 * TOO_FAST, PULSE_TOO_SHORT, STATEMENT, NOT_IDLE (the core refuses); the settings before are to be applied
 * again then. */
enum passo_gcode_error passo_grbl_apply(struct passo_grbl *grbl);
/* Loads what is stored, or else the defaults. Error: STORAGE. */
enum passo_gcode_error passo_grbl_load(struct passo_grbl *grbl);
/* Error: STORAGE. */
enum passo_gcode_error passo_grbl_save(struct passo_grbl *grbl);
/* `$n=` and `$Nx=`: the text behind the `$`. */
enum passo_gcode_error passo_grbl_change(struct passo_grbl *grbl, const char *text);
/* `$RST=`: the letter. */
enum passo_gcode_error passo_grbl_restore(struct passo_grbl *grbl, const char *text);

/* `$H`; passo_grbl_poll_home() answers it at its end. */
enum passo_gcode_error passo_grbl_home(struct passo_grbl *grbl);
void passo_grbl_poll_home(struct passo_grbl *grbl);

/* A line that begins with `$`. */
enum passo_gcode_error passo_grbl_system(struct passo_grbl *grbl, const char *text);

#endif
