/* SPDX-License-Identifier: MIT
 * A simulated core at the Unix socket of `passo serve`. All messages are words, the most significant byte
 * first; sim/passo/serve.py is the other end.
 *
 *     greeting   from the server: PASSO_SERVE_GREETING, then 0: simulated time, 1: real time, 2: it is busy
 *     frame      n, n words            answer: microseconds, irq, n words
 *     time       0, microseconds       answer: microseconds, irq
 */
#define _DEFAULT_SOURCE
#include <arpa/inet.h>
#include <errno.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include "passo_linux_private.h"

#define GREETING UINT32_C(0x50415353) /* "PASS" */
#define GREETING_WORDS 2u
#define ANSWER_WORDS 2u
enum { SIMULATED_TIME, REAL_TIME, BUSY };

static bool exchange(struct passo_linux *host, uint32_t *words, size_t sent, size_t received)
{
	size_t done = 0;

	for (size_t i = 0; i < sent; i++)
		words[i] = htonl(words[i]);
	if (sent > 0u
	    && send(host->device, words, sent * sizeof *words, MSG_NOSIGNAL)
	           != (ssize_t)(sent * sizeof *words))
		return false;
	while (done < received * sizeof *words) {
		const ssize_t more =
		    recv(host->device, (char *)words + done, received * sizeof *words - done, MSG_WAITALL);
		if (more <= 0 && !(more < 0 && errno == EINTR))
			return false;
		done += more > 0 ? (size_t)more : 0u;
	}
	for (size_t i = 0; i < received; i++)
		words[i] = ntohl(words[i]);
	return true;
}

/* A request whose answer begins with the time and irq. */
static bool request(struct passo_linux *host, uint32_t *words, size_t sent, size_t received)
{
	if (!exchange(host, words, sent, received))
		return false;
	host->microseconds = words[0];
	host->irq_level = words[1] != 0u;
	return true;
}

static bool transfer(void *context, const uint32_t *mosi, uint32_t *miso, size_t words)
{
	struct passo_linux *host = context;
	uint32_t message[PASSO_FRAME_WORDS_MAX + ANSWER_WORDS];

	host->words += (uint32_t)words;
	message[0] = (uint32_t)words;
	memcpy(message + 1, mosi, words * sizeof *mosi);
	if (!request(context, message, words + 1u, words + ANSWER_WORDS))
		return false;
	memcpy(miso, message + ANSWER_WORDS, words * sizeof *miso);
	return true;
}

static uint32_t microseconds(void *context)
{
	const struct passo_linux *host = context;

	return host->real_time ? passo_linux_microseconds(context) : host->microseconds;
}

static void wait(void *context, uint32_t microseconds)
{
	struct passo_linux *host = context;
	uint32_t message[ANSWER_WORDS] = {0, microseconds > 0u ? microseconds : 1u};

	if (host->real_time)
		passo_linux_sleep(context, microseconds);
	request(host, message, ANSWER_WORDS, ANSWER_WORDS); /* a server that is gone fails the next frame */
}

static bool irq(void *context)
{
	return ((const struct passo_linux *)context)->irq_level;
}

bool passo_linux_open_socket(
    struct passo_linux *host, const struct passo_linux_options *device, struct passo_hardware *hardware)
{
	const char *path = strchr(device->device, ':') + 1;
	struct sockaddr_un address = {.sun_family = AF_UNIX};
	uint32_t greeting[GREETING_WORDS];

	if (strlen(path) >= sizeof address.sun_path)
		return passo_linux_fail(host, "%s: the path of a socket has at most %zu letters",
		    device->device, sizeof address.sun_path - 1u);
	strcpy(address.sun_path, path);
	host->device = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
	if (host->device < 0 || connect(host->device, (struct sockaddr *)&address, sizeof address) != 0)
		return passo_linux_fail(host, "%s: %s: start the simulation: passo serve %s", device->device,
		    strerror(errno), path);
	if (!exchange(host, greeting, 0, GREETING_WORDS) || greeting[0] != GREETING)
		return passo_linux_fail(host, "%s: this is not the socket of passo serve", device->device);
	if (greeting[1] == BUSY)
		return passo_linux_fail(
		    host, "%s: another program holds it: end that one first", device->device);
	host->real_time = greeting[1] == REAL_TIME;
	hardware->transfer = transfer;
	hardware->microseconds = microseconds;
	hardware->wait = wait;
	hardware->irq = irq;
	return true;
}
