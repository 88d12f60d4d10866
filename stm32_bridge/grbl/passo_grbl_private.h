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
/* In the units of reports: lengths in nanometres, speeds in mm/min. */
void passo_grbl_say_length(struct passo_grbl *grbl, int64_t nanometres);
void passo_grbl_say_position(struct passo_grbl *grbl, const char *name, const int64_t *position);
uint64_t passo_grbl_in_units(const struct passo_grbl *grbl, uint64_t millimetres);
void passo_grbl_report(struct passo_grbl *grbl);
void passo_grbl_report_modes(struct passo_grbl *grbl);
void passo_grbl_report_offsets(struct passo_grbl *grbl);
void passo_grbl_report_probe(struct passo_grbl *grbl);
void passo_grbl_report_settings(struct passo_grbl *grbl);
void passo_grbl_report_starts(struct passo_grbl *grbl);
void passo_grbl_answer(struct passo_grbl *grbl, enum passo_gcode_error error);
void passo_grbl_alarm(struct passo_grbl *grbl, enum passo_grbl_alarm alarm);
void passo_grbl_greet(struct passo_grbl *grbl);

/* Clears a flag; returns what it was. */
bool passo_grbl_take(volatile bool *flag);
/* What the real-time bytes ask for. */
void passo_grbl_obey(struct passo_grbl *grbl);
/* Stops, and drops what waits. */
void passo_grbl_begin_stop(struct passo_grbl *grbl, bool resets);
/* Once the machine rests: the program goes on from where it is. Returns whether something has been said. */
bool passo_grbl_end_stop(struct passo_grbl *grbl);
/* The overrides of feed, rapids and spindle are in force. */
void passo_grbl_override(struct passo_grbl *grbl);

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
