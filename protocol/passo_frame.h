/* SPDX-License-Identifier: MIT
 * The frame codec: builds the frames that a host sends over SPI and reads the replies.
 *
 * A frame is one chip select. The request and its reply have the same number of words:
 *
 *     write, push  MOSI  header  payload x length    crc     0       0
 *                  MISO  status  status ...          status  status  ack
 *     read         MOSI  header  crc     0       0 x length    0
 *                  MISO  status  status  status  data x length  crc
 */
#ifndef PASSO_FRAME_H
#define PASSO_FRAME_H

#include <stddef.h>
#include <stdint.h>

#include "passo_command.h"
#include "passo_crc.h"
#include "passo_registers.h"

#define PASSO_FRAME_PAYLOAD_MAX 60u
/* Words of a frame beside its payload or data; those before the data of a read. */
#define PASSO_FRAME_OVERHEAD 4u
#define PASSO_FRAME_DATA 3u
#define PASSO_FRAME_WORDS_MAX (PASSO_FRAME_PAYLOAD_MAX + PASSO_FRAME_OVERHEAD)

/* Words of a line for a core of `axes` axes, and of a ramp. */
#define PASSO_LINE_WORDS(axes) ((axes) + 2u)
#define PASSO_RAMP_WORDS 5u

/* What a reply tells. Only after PASSO_REPLY_OK and PASSO_REPLY_REFUSED is the frame's fate certain. */
enum passo_reply {
	PASSO_REPLY_OK,      /* a write was executed (or is a duplicate), a read brought its data */
	PASSO_REPLY_REFUSED, /* the verdict says why */
	PASSO_REPLY_STUCK,   /* MISO never moved: no core, no power, no connection */
	PASSO_REPLY_NO_ACK,  /* the status stands in place of the ack: the core took the frame for unfinished
	                      */
	PASSO_REPLY_DAMAGED, /* the ack or the data do not agree with their check */
	PASSO_REPLY_SEQUENCE /* the ack of another frame */
};

/* Each builds a frame of length + PASSO_FRAME_OVERHEAD words and returns that number. The payload may stand
 * at frame + 1 already. */
size_t passo_frame_write(
    uint32_t *frame, uint8_t sequence, uint16_t address, const uint32_t *payload, size_t length);
size_t passo_frame_push(
    uint32_t *frame, uint8_t sequence, uint16_t address, const uint32_t *payload, size_t length);
size_t passo_frame_read(uint32_t *frame, uint8_t sequence, uint16_t address, size_t length);
/* The bits of a status word that never change are right; shifted by a bit they are not. */
bool passo_frame_is_status(uint32_t word);

/* Both judge the reply to a request of `count` words. *verdict is set unless the reply is useless; a read's
 * data are the words from miso[PASSO_FRAME_DATA] on. */
enum passo_reply passo_frame_write_reply(
    const uint32_t *mosi, const uint32_t *miso, size_t count, enum passo_verdict *verdict);
enum passo_reply passo_frame_read_reply(
    const uint32_t *mosi, const uint32_t *miso, size_t count, enum passo_verdict *verdict);

/* Payload words of one line (PASSO_LINE_WORDS) or ramp (PASSO_RAMP_WORDS). Both return their number. */
size_t passo_line_words(uint32_t *words, const struct passo_line *line, uint8_t axes);
size_t passo_ramp_words(uint32_t *words, const struct passo_ramp *ramp);

#endif
