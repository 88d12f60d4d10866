/* SPDX-License-Identifier: MIT
 * Internal: shared by the sources of passo_cpu.h.
 */
#ifndef PASSO_CPU_PRIVATE_H
#define PASSO_CPU_PRIVATE_H

#include <unicorn/unicorn.h>

#include "passo_cpu.h"

#define PASSO_CPU_FLASH 0x08000000u
#define PASSO_CPU_RAM 0x20000000u
#define PASSO_CPU_SYSTEM 0x1FFFF000u /* a page of the chip's own memory */
#define PASSO_CPU_FLASH_KILOBYTES 0x1FFFF7E0u

struct cpu {
	struct passo_cpu public; /* first member: a pointer to it is also one to struct cpu */
	struct passo_cpu_config config;
	uc_engine *uc;
	uint8_t *flash, *ram;
	bool may_unmask;
	uint8_t *programmed; /* half-words that unicorn may have overwritten, or NULL */
	uint8_t as_programmed[4];
	bool held; /* a stop was requested before the instruction at held_address */
	uint32_t held_address;
	enum passo_cpu_stop stop;
};

static inline struct cpu *passo_cpu_whole(struct passo_cpu *cpu)
{
	return (struct cpu *)cpu;
}

static inline uint32_t passo_cpu_get(struct cpu *cpu, int id)
{
	uint32_t value = 0;

	uc_reg_read(cpu->uc, id, &value);
	return value;
}

static inline void passo_cpu_set(struct cpu *cpu, int id, uint32_t value)
{
	uc_reg_write(cpu->uc, id, &value);
}

/* Starts unicorn with the memories and with what it calls. */
bool passo_cpu_open(struct cpu *cpu);

/* Accounts for an instruction: time and profile. */
void passo_cpu_count(struct cpu *cpu, uint32_t address);

/* After a store into flash: what it has become. */
void passo_cpu_settle(struct cpu *cpu);

#endif
