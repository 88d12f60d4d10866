/* SPDX-License-Identifier: MIT
 * The frame codec: builds the request frames of a host and decodes the replies.
 *
 * A frame is one chip select. Request and reply have the same number of words:
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

/* Most payload or data words. */
#define PASSO_FRAME_PAYLOAD_MAX 60u
/* Words of a frame other than payload or data; index of the first data word in the reply to a read. */
#define PASSO_FRAME_OVERHEAD 4u
#define PASSO_FRAME_DATA 3u
#define PASSO_FRAME_WORDS_MAX (PASSO_FRAME_PAYLOAD_MAX + PASSO_FRAME_OVERHEAD)

/* Payload words of a line on a core with `axes` axes per channel, without the output word, which is the last
 * one on a core with OUTPUTS; and of a ramp. */
#define PASSO_LINE_WORDS(axes) ((axes) + 2u)
#define PASSO_RAMP_WORDS 5u

/* Result of a reply. Only PASSO_REPLY_OK and PASSO_REPLY_REFUSED tell whether the frame was executed. */
enum passo_reply {
	PASSO_REPLY_OK,      /* the write was executed, now or before (duplicate); the read data are valid */
	PASSO_REPLY_REFUSED, /* the verdict says why */
	PASSO_REPLY_STUCK,   /* MISO never changed: no core, no power, no connection */
	PASSO_REPLY_NO_ACK,  /* status instead of the ack: the core saw an incomplete frame */
	PASSO_REPLY_DAMAGED, /* the ack or the data failed their check */
	PASSO_REPLY_SEQUENCE /* the ack belongs to another frame */
};

/* Each builds a request of length + PASSO_FRAME_OVERHEAD words in `frame` and returns that number. `length`
 * is 1 .. PASSO_FRAME_PAYLOAD_MAX and `address` a word address below 2^12; neither is checked. The payload
 * may already be at frame + 1. */
size_t passo_frame_write(
    uint32_t *frame, uint8_t sequence, uint16_t address, const uint32_t *payload, size_t length);
size_t passo_frame_push(
    uint32_t *frame, uint8_t sequence, uint16_t address, const uint32_t *payload, size_t length);
size_t passo_frame_read(uint32_t *frame, uint8_t sequence, uint16_t address, size_t length);
/* Whether the constant bits of a status word are valid. They are not if the reply is shifted by a bit. */
bool passo_frame_is_status(uint32_t word);

/* Both decode the reply to a request of `count` words. *verdict is valid only with PASSO_REPLY_OK and
 * PASSO_REPLY_REFUSED. The data of a read start at miso[PASSO_FRAME_DATA]. */
enum passo_reply passo_frame_write_reply(
    const uint32_t *mosi, const uint32_t *miso, size_t count, enum passo_verdict *verdict);
enum passo_reply passo_frame_read_reply(
    const uint32_t *mosi, const uint32_t *miso, size_t count, enum passo_verdict *verdict);

/* Both encode a command into payload words (PASSO_LINE_WORDS, PASSO_RAMP_WORDS) and return their number.
 * Values are not checked. */
size_t passo_line_words(uint32_t *words, const struct passo_line *line, uint8_t axes);
size_t passo_ramp_words(uint32_t *words, const struct passo_ramp *ramp);

#endif
