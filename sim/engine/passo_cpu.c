/* SPDX-License-Identifier: MIT
 * A Cortex-M3 on unicorn: its memories, and its run to the next stop. See passo_cpu.h.
 */
#include <stdlib.h>
#include <string.h>

#include "passo_cpu_private.h"

#define NOWHERE 0xFFFFFFF6u /* an address that is never executed */

uint8_t *passo_cpu_memory(struct passo_cpu *cpu, uint32_t address, uint32_t *size)
{
	struct cpu *own = passo_cpu_whole(cpu);

	if (address < own->config.flash_size)
		address += PASSO_CPU_FLASH;
	if (address >= PASSO_CPU_FLASH && address - PASSO_CPU_FLASH < own->config.flash_size) {
		*size = own->config.flash_size - (address - PASSO_CPU_FLASH);
		return own->flash + (address - PASSO_CPU_FLASH);
	}
	if (address >= PASSO_CPU_RAM && address - PASSO_CPU_RAM < own->config.ram_size) {
		*size = own->config.ram_size - (address - PASSO_CPU_RAM);
		return own->ram + (address - PASSO_CPU_RAM);
	}
	*size = 0;
	return NULL;
}

struct passo_cpu *passo_cpu_create(const struct passo_cpu_config *config)
{
	struct cpu *cpu = calloc(1, sizeof *cpu);

	if (!cpu)
		return NULL;
	cpu->config = *config;
	cpu->public.step = 1;
	/* unicorn maps whole pages */
	cpu->flash = aligned_alloc(4096, config->flash_size);
	cpu->ram = aligned_alloc(4096, config->ram_size);
	if (!cpu->flash || !cpu->ram) {
		passo_cpu_destroy(&cpu->public);
		return NULL;
	}
	memset(cpu->flash, 0xFF, config->flash_size);
	memset(cpu->ram, 0, config->ram_size);
	if (!passo_cpu_open(cpu)) {
		passo_cpu_destroy(&cpu->public);
		return NULL;
	}
	return &cpu->public;
}

void passo_cpu_destroy(struct passo_cpu *cpu)
{
	struct cpu *own = passo_cpu_whole(cpu);

	if (!cpu)
		return;
	if (own->uc)
		uc_close(own->uc);
	free(own->flash);
	free(own->ram);
	free(own);
}

enum passo_cpu_stop passo_cpu_run(struct passo_cpu *cpu)
{
	struct cpu *own = passo_cpu_whole(cpu);
	uc_err error;

	own->held = false;
	own->stop = PASSO_CPU_FAULT;
	cpu->fault = 0;
	cpu->fault_address = 0;
	error = uc_emu_start(own->uc, passo_cpu_get(own, UC_ARM_REG_PC) | 1u, NOWHERE, 0, 0);
	passo_cpu_settle(own);
	if (error != UC_ERR_OK) {
		cpu->fault = (int32_t)error;
		return PASSO_CPU_FAULT;
	}
	if (own->held && own->held_address != passo_cpu_get(own, UC_ARM_REG_PC))
		passo_cpu_count(own, own->held_address);
	if (own->stop == PASSO_CPU_SLEEP)
		passo_cpu_set_pc(cpu, passo_cpu_get(own, UC_ARM_REG_PC) + 2);
	return own->stop;
}
