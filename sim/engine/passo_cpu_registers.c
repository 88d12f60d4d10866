/* SPDX-License-Identifier: MIT
 * Registers of the processor: reset, exception entry and return. See passo_cpu.h.
 */
#include <string.h>

#include "passo_cpu_private.h"

#define EXCEPTION_CYCLES 12u
#define XPSR_THUMB (1u << 24)
#define XPSR_ALIGNED (1u << 9)
#define XPSR_IT 0x0600FC00u
#define FRAME 32u

static uint32_t load(struct cpu *cpu, uint32_t address)
{
	uint32_t size, word = 0;
	const uint8_t *from = passo_cpu_memory(&cpu->public, address, &size);

	if (from && size >= sizeof word)
		memcpy(&word, from, sizeof word);
	return word;
}

void passo_cpu_set_pc(struct passo_cpu *cpu, uint32_t address)
{
	passo_cpu_set(passo_cpu_whole(cpu), UC_ARM_REG_PC, address | 1u);
}

void passo_cpu_reset(struct passo_cpu *cpu)
{
	struct cpu *own = passo_cpu_whole(cpu);

	for (int id = UC_ARM_REG_R0; id <= UC_ARM_REG_R12; id++)
		passo_cpu_set(own, id, 0);
	passo_cpu_set(own, UC_ARM_REG_PRIMASK, 0);
	passo_cpu_set(own, UC_ARM_REG_FAULTMASK, 0);
	passo_cpu_set(own, UC_ARM_REG_BASEPRI, 0);
	passo_cpu_set(own, UC_ARM_REG_CONTROL, 0);
	passo_cpu_set(own, UC_ARM_REG_XPSR, XPSR_THUMB);
	passo_cpu_set(own, UC_ARM_REG_IPSR, 0);
	passo_cpu_set(own, UC_ARM_REG_SP, load(own, 0) & ~3u);
	passo_cpu_set(own, UC_ARM_REG_LR, 0xFFFFFFFF);
	passo_cpu_set_pc(cpu, load(own, 4));
	own->may_unmask = false;
}

void passo_cpu_enter(struct passo_cpu *cpu, uint32_t exception, uint32_t handler)
{
	struct cpu *own = passo_cpu_whole(cpu);
	const uint32_t sp = passo_cpu_get(own, UC_ARM_REG_SP), aligned = (sp - FRAME) & ~7u;
	uint32_t size, xpsr = passo_cpu_get(own, UC_ARM_REG_XPSR) | XPSR_THUMB;
	uint8_t *to = passo_cpu_memory(cpu, aligned, &size);
	uint32_t frame[FRAME / 4] = {passo_cpu_get(own, UC_ARM_REG_R0), passo_cpu_get(own, UC_ARM_REG_R1),
	    passo_cpu_get(own, UC_ARM_REG_R2), passo_cpu_get(own, UC_ARM_REG_R3),
	    passo_cpu_get(own, UC_ARM_REG_R12), passo_cpu_get(own, UC_ARM_REG_LR),
	    passo_cpu_get(own, UC_ARM_REG_PC) & ~1u,
	    (xpsr & ~XPSR_ALIGNED) | (aligned + FRAME == sp ? 0 : XPSR_ALIGNED)};

	if (to && size >= FRAME)
		memcpy(to, frame, FRAME);
	passo_cpu_set(own, UC_ARM_REG_SP, aligned);
	passo_cpu_set(own, UC_ARM_REG_LR, xpsr & 0x1FF ? 0xFFFFFFF1 : 0xFFFFFFF9);
	passo_cpu_set(own, UC_ARM_REG_XPSR, (xpsr & ~(XPSR_IT | 0x1FFu)) | exception);
	passo_cpu_set(own, UC_ARM_REG_IPSR, exception);
	passo_cpu_set_pc(cpu, handler);
	cpu->now += EXCEPTION_CYCLES * cpu->step;
}

bool passo_cpu_return(struct passo_cpu *cpu)
{
	struct cpu *own = passo_cpu_whole(cpu);
	const uint32_t value = passo_cpu_get(own, UC_ARM_REG_PC) | 1u, sp = passo_cpu_get(own, UC_ARM_REG_SP);
	uint32_t size, frame[FRAME / 4];
	const uint8_t *from = passo_cpu_memory(cpu, sp, &size);

	if (!from || size < FRAME)
		return false;
	memcpy(frame, from, FRAME);
	if (value != (frame[7] & 0x1FF ? 0xFFFFFFF1 : 0xFFFFFFF9))
		return false;
	passo_cpu_set(own, UC_ARM_REG_R0, frame[0]);
	passo_cpu_set(own, UC_ARM_REG_R1, frame[1]);
	passo_cpu_set(own, UC_ARM_REG_R2, frame[2]);
	passo_cpu_set(own, UC_ARM_REG_R3, frame[3]);
	passo_cpu_set(own, UC_ARM_REG_R12, frame[4]);
	passo_cpu_set(own, UC_ARM_REG_LR, frame[5]);
	passo_cpu_set(own, UC_ARM_REG_SP, sp + FRAME + (frame[7] & XPSR_ALIGNED ? 4 : 0));
	passo_cpu_set(own, UC_ARM_REG_IPSR, frame[7] & 0x1FF);
	passo_cpu_set(own, UC_ARM_REG_XPSR, frame[7] & ~XPSR_ALIGNED);
	passo_cpu_set_pc(cpu, frame[6]);
	cpu->now += EXCEPTION_CYCLES * cpu->step;
	return true;
}

uint32_t passo_cpu_ipsr(struct passo_cpu *cpu)
{
	return passo_cpu_get(passo_cpu_whole(cpu), UC_ARM_REG_IPSR) & 0x1FF;
}

uint32_t passo_cpu_masks(struct passo_cpu *cpu)
{
	struct cpu *own = passo_cpu_whole(cpu);

	return (passo_cpu_get(own, UC_ARM_REG_PRIMASK) & 1)
	     | (passo_cpu_get(own, UC_ARM_REG_FAULTMASK) & 1) << 1
	     | (passo_cpu_get(own, UC_ARM_REG_CONTROL) & 3) << 8
	     | (passo_cpu_get(own, UC_ARM_REG_BASEPRI) & 0xFF) << 16;
}

void passo_cpu_registers(struct passo_cpu *cpu, uint32_t values[PASSO_CPU_REGISTERS])
{
	struct cpu *own = passo_cpu_whole(cpu);

	for (int i = 0; i <= 12; i++)
		values[i] = passo_cpu_get(own, UC_ARM_REG_R0 + i);
	values[13] = passo_cpu_get(own, UC_ARM_REG_SP);
	values[14] = passo_cpu_get(own, UC_ARM_REG_LR);
	values[15] = passo_cpu_get(own, UC_ARM_REG_PC);
	values[16] = passo_cpu_get(own, UC_ARM_REG_XPSR);
}
