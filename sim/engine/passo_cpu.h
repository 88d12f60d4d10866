/* SPDX-License-Identifier: MIT
 * A Cortex-M3 with its memories: unicorn executes the instructions, this file keeps the time and makes what
 * unicorn lacks: stops at an exact time, sleep, exception entry and return.
 *
 * Time runs in ticks. Every instruction takes `step` ticks, exception entry and return take 12 times that.
 * The bus behind the memories is the caller's; `now` is then the end of the instruction that accesses it.
 */
#ifndef PASSO_CPU_H
#define PASSO_CPU_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define PASSO_CPU_REGISTERS 17u /* r0 .. r12, sp, lr, pc, xpsr */

enum passo_cpu_stop {
	PASSO_CPU_DEADLINE,         /* the next instruction would begin at the deadline or later */
	PASSO_CPU_SLEEP,            /* WFI; the program counter is behind it */
	PASSO_CPU_EXCEPTION_RETURN, /* call passo_cpu_return() */
	PASSO_CPU_SUPERVISOR_CALL,  /* SVC */
	PASSO_CPU_BREAKPOINT,       /* `breakpoint` is next; it is cleared */
	PASSO_CPU_FAULT             /* `fault` says what, pc which instruction, `fault_address` where */
};

struct passo_cpu_config {
	uint32_t flash_size, ram_size; /* at 0x08000000, and once more at 0; at 0x20000000 */
	uint32_t (*read)(void *user, uint32_t address, uint32_t size);
	void (*write)(void *user, uint32_t address, uint32_t size, uint32_t value);
	void *user;
};

/* What the caller may read, and the second half write, at any time. */
struct passo_cpu {
	uint64_t now;          /* ticks */
	uint64_t instructions; /* executed since the machine was made */
	uint32_t address;      /* of the instruction that is executed */
	int32_t fault;         /* an error of unicorn; 0: an exception of the processor's own */
	uint32_t fault_address;

	uint64_t deadline;   /* ticks; may be moved while instructions are executed */
	uint32_t step;       /* ticks per instruction */
	bool watch_masks;    /* stop behind an instruction that may let a masked interrupt through */
	uint32_t breakpoint; /* address of an instruction outside of IT blocks, or 0 */
	uint32_t *profile;   /* NULL, or a counter for each halfword of flash */
};

/* NULL when unicorn does not come up. Memories are 0; registers are undefined until the reset. */
struct passo_cpu *passo_cpu_create(const struct passo_cpu_config *config);
void passo_cpu_destroy(struct passo_cpu *cpu);

/* Registers as the core's reset leaves them, stack pointer and program counter from the vectors at 0. */
void passo_cpu_reset(struct passo_cpu *cpu);

enum passo_cpu_stop passo_cpu_run(struct passo_cpu *cpu);

/* Exception entry: stacks the frame, continues at `handler`. Return: whether EXC_RETURN is one to the main
 * stack. */
void passo_cpu_enter(struct passo_cpu *cpu, uint32_t exception, uint32_t handler);
bool passo_cpu_return(struct passo_cpu *cpu);

uint32_t passo_cpu_ipsr(struct passo_cpu *cpu);
/* PRIMASK (bit 0), FAULTMASK (bit 1), CONTROL (bits 9:8), BASEPRI (bits 23:16). */
uint32_t passo_cpu_masks(struct passo_cpu *cpu);
void passo_cpu_registers(struct passo_cpu *cpu, uint32_t values[PASSO_CPU_REGISTERS]);
void passo_cpu_set_pc(struct passo_cpu *cpu, uint32_t address);

/* The memories' bytes from `address` on, or NULL if there is no memory; `size` is what is left of it. */
uint8_t *passo_cpu_memory(struct passo_cpu *cpu, uint32_t address, uint32_t *size);

#ifdef __cplusplus
}
#endif

#endif
