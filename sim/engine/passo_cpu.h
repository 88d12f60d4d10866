/* SPDX-License-Identifier: MIT
 * A Cortex-M3 with its memories: unicorn executes the instructions; this module keeps time and adds what
 * unicorn lacks: stops at an exact time, sleep, exception entry and return.
 *
 * Time runs in ticks. Every instruction takes `step` ticks, exception entry and return take 12 times that.
 * Accesses outside the memories go to the caller; `now` is then the end of the accessing instruction.
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
	PASSO_CPU_DEADLINE,         /* the next instruction would start at the deadline or later */
	PASSO_CPU_SLEEP,            /* WFI; the program counter is after it */
	PASSO_CPU_EXCEPTION_RETURN, /* call passo_cpu_return() */
	PASSO_CPU_SUPERVISOR_CALL,  /* SVC */
	PASSO_CPU_BREAKPOINT,       /* `breakpoint` is the next instruction; it is cleared */
	PASSO_CPU_FAULT             /* see `fault`, `address` and `fault_address` */
};

struct passo_cpu_config {
	uint32_t flash_size; /* at 0x08000000, and once more at 0; the chip tells it */
	uint32_t ram_size;   /* at 0x20000000 */
	uint32_t (*read)(void *user, uint32_t address, uint32_t size);
	void (*write)(void *user, uint32_t address, uint32_t size, uint32_t value);
	/* A store into flash, which the processor itself does not change; false: it is a fault. */
	bool (*program)(void *user, uint32_t address, uint32_t size, uint32_t value);
	void *user;
};

/* The caller may read all members, and write those from `deadline` on, at any time. */
struct passo_cpu {
	uint64_t now;          /* ticks */
	uint64_t instructions; /* executed since the machine was made */
	uint32_t address;      /* of the instruction that is executed */
	int32_t fault;         /* an error of unicorn; 0: an exception of the processor's own */
	uint32_t fault_address;

	uint64_t deadline;   /* ticks; may be changed during execution */
	uint32_t step;       /* ticks per instruction */
	bool watch_masks;    /* stop after an instruction that may unmask an interrupt */
	uint32_t breakpoint; /* address of an instruction outside of IT blocks, or 0 */
	uint32_t *profile;   /* NULL, or a counter for each halfword of flash */
};

/* NULL if unicorn cannot be started. Memories are 0; registers are undefined until the reset. */
struct passo_cpu *passo_cpu_create(const struct passo_cpu_config *config);
void passo_cpu_destroy(struct passo_cpu *cpu);

/* Resets the registers; stack pointer and program counter come from the vectors at 0. */
void passo_cpu_reset(struct passo_cpu *cpu);

enum passo_cpu_stop passo_cpu_run(struct passo_cpu *cpu);

/* Exception entry: stacks the frame and continues at `handler`. Exception return: unstacks the frame; false
 * unless EXC_RETURN selects the main stack. */
void passo_cpu_enter(struct passo_cpu *cpu, uint32_t exception, uint32_t handler);
bool passo_cpu_return(struct passo_cpu *cpu);

uint32_t passo_cpu_ipsr(struct passo_cpu *cpu);
/* PRIMASK (bit 0), FAULTMASK (bit 1), CONTROL (bits 9:8), BASEPRI (bits 23:16). */
uint32_t passo_cpu_masks(struct passo_cpu *cpu);
void passo_cpu_registers(struct passo_cpu *cpu, uint32_t values[PASSO_CPU_REGISTERS]);
void passo_cpu_set_pc(struct passo_cpu *cpu, uint32_t address);

/* Pointer to the memory at `address`, or NULL if there is none; *size is the number of bytes from there
 * on. */
uint8_t *passo_cpu_memory(struct passo_cpu *cpu, uint32_t address, uint32_t *size);

#ifdef __cplusplus
}
#endif

#endif
