/* SPDX-License-Identifier: MIT
 * What unicorn calls: instructions, interrupts, accesses outside the memories. See passo_cpu.h.
 */
#include <string.h>

#include "passo_cpu_private.h"

#define WAIT_FOR_INTERRUPT 0xBF30u

/* unicorn's numbers of these exceptions */
#define INTERRUPT_SVC 2u
#define INTERRUPT_EXCEPTION_EXIT 8u

static void stop(struct cpu *cpu, enum passo_cpu_stop reason)
{
	cpu->stop = reason;
	uc_emu_stop(cpu->uc);
}

void passo_cpu_count(struct cpu *cpu, uint32_t address)
{
	struct passo_cpu *public = &cpu->public;
	uint32_t size;
	const uint8_t *code = passo_cpu_memory(public, address, &size);
	uint16_t opcode = 0;

	public->address = address;
	public->now += public->step;
	public->instructions++;
	if (!code)
		return;
	if (public->profile && code >= cpu->flash && code < cpu->flash + cpu->config.flash_size)
		public->profile[(code - cpu->flash) / 2]++;
	memcpy(&opcode, code, sizeof opcode);
	if (opcode == WAIT_FOR_INTERRUPT)
		stop(cpu, PASSO_CPU_SLEEP);
	else if (public->watch_masks && (opcode == 0xB662 || opcode == 0xB661 || (opcode & 0xFFE0) == 0xF380))
		cpu->may_unmask = true; /* cpsie i, cpsie f, msr */
}

void passo_cpu_settle(struct cpu *cpu)
{
	if (cpu->programmed)
		memcpy(cpu->programmed, cpu->as_programmed, sizeof cpu->as_programmed);
	cpu->programmed = NULL;
}

/* Called before each instruction whose condition is true. Inside an IT block unicorn continues in spite of a
 * stop; the next call shows that the instruction that was to be held back has been executed. */
static void on_instruction(uc_engine *uc, uint64_t address, uint32_t length, void *user)
{
	struct cpu *cpu = user;
	struct passo_cpu *public = &cpu->public;

	(void)uc;
	(void)length;
	passo_cpu_settle(cpu);
	if (cpu->held)
		passo_cpu_count(cpu, cpu->held_address);
	if (cpu->may_unmask) {
		cpu->may_unmask = false;
		if (public->deadline > public->now)
			public->deadline = public->now;
	}
	cpu->held = public->now >= public->deadline;
	cpu->held_address = (uint32_t)address;
	if (cpu->held) {
		stop(cpu, PASSO_CPU_DEADLINE);
	} else if (public->breakpoint && public->breakpoint == address) {
		public->breakpoint = 0;
		cpu->held = true;
		stop(cpu, PASSO_CPU_BREAKPOINT);
	} else {
		passo_cpu_count(cpu, (uint32_t)address);
	}
}

static void on_interrupt(uc_engine *uc, uint32_t number, void *user)
{
	struct cpu *cpu = user;

	(void)uc;
	cpu->public.fault = 0;
	if (number == INTERRUPT_EXCEPTION_EXIT)
		stop(cpu, PASSO_CPU_EXCEPTION_RETURN);
	else if (number == INTERRUPT_SVC)
		stop(cpu, PASSO_CPU_SUPERVISOR_CALL);
	else
		stop(cpu, PASSO_CPU_FAULT);
}

static bool on_bad_access(
    uc_engine *uc, uc_mem_type type, uint64_t address, int size, int64_t value, void *user)
{
	(void)uc, (void)type, (void)size, (void)value;
	((struct cpu *)user)->public.fault_address = (uint32_t)address;
	return false;
}

/* unicorn may store the value as well when this has returned true: passo_cpu_settle() undoes it. */
static bool on_store_into_flash(
    uc_engine *uc, uc_mem_type type, uint64_t address, int size, int64_t value, void *user)
{
	struct cpu *cpu = user;
	uint32_t left;

	(void)uc, (void)type;
	cpu->public.fault_address = (uint32_t)address;
	if (!cpu->config.program(cpu->config.user, (uint32_t)address, (uint32_t)size, (uint32_t)value))
		return false;
	cpu->programmed = passo_cpu_memory(&cpu->public, (uint32_t)address & ~3u, &left);
	memcpy(cpu->as_programmed, cpu->programmed, sizeof cpu->as_programmed);
	return true;
}

static uint64_t on_read(uc_engine *uc, uint64_t offset, unsigned size, void *user)
{
	struct cpu *cpu = user;

	(void)uc;
	return cpu->config.read(cpu->config.user, (uint32_t)offset + 0x40000000u, size);
}

static void on_write(uc_engine *uc, uint64_t offset, unsigned size, uint64_t value, void *user)
{
	struct cpu *cpu = user;

	(void)uc;
	cpu->config.write(cpu->config.user, (uint32_t)offset + 0x40000000u, size, (uint32_t)value);
}

static uint64_t on_system_read(uc_engine *uc, uint64_t offset, unsigned size, void *user)
{
	return on_read(uc, offset + 0xA0000000u, size, user);
}

static void on_system_write(uc_engine *uc, uint64_t offset, unsigned size, uint64_t value, void *user)
{
	on_write(uc, offset + 0xA0000000u, size, value, user);
}

static bool hook(struct cpu *cpu, int type, void *callback)
{
	uc_hook handle;

	return uc_hook_add(cpu->uc, &handle, type, callback, cpu, 1, 0) == UC_ERR_OK;
}

bool passo_cpu_open(struct cpu *cpu)
{
	const struct passo_cpu_config *config = &cpu->config;
	const uint32_t code = UC_PROT_READ | UC_PROT_EXEC, kilobytes = config->flash_size >> 10;
	union {
		void (*on_instruction)(uc_engine *, uint64_t, uint32_t, void *);
		void (*on_interrupt)(uc_engine *, uint32_t, void *);
		bool (*on_bad_access)(uc_engine *, uc_mem_type, uint64_t, int, int64_t, void *);
		void *pointer;
	} callback;

	if (uc_open(UC_ARCH_ARM, UC_MODE_THUMB | UC_MODE_MCLASS, &cpu->uc) != UC_ERR_OK)
		return false;
	if (uc_ctl_set_cpu_model(cpu->uc, UC_CPU_ARM_CORTEX_M3) != UC_ERR_OK
	    || uc_mem_map_ptr(cpu->uc, 0, config->flash_size, code, cpu->flash) != UC_ERR_OK
	    || uc_mem_map_ptr(cpu->uc, PASSO_CPU_FLASH, config->flash_size, code, cpu->flash) != UC_ERR_OK
	    || uc_mem_map_ptr(cpu->uc, PASSO_CPU_RAM, config->ram_size, UC_PROT_ALL, cpu->ram) != UC_ERR_OK
	    || uc_mem_map(cpu->uc, PASSO_CPU_SYSTEM, 0x1000, UC_PROT_READ) != UC_ERR_OK
	    || uc_mem_write(cpu->uc, PASSO_CPU_FLASH_KILOBYTES, &kilobytes, 2) != UC_ERR_OK
	    || uc_mmio_map(cpu->uc, 0x40000000, 0x10000000, on_read, cpu, on_write, cpu) != UC_ERR_OK
	    || uc_mmio_map(cpu->uc, 0xE0000000, 0x00100000, on_system_read, cpu, on_system_write, cpu)
	           != UC_ERR_OK)
		return false;
	callback.on_instruction = on_instruction;
	if (!hook(cpu, UC_HOOK_CODE, callback.pointer))
		return false;
	callback.on_interrupt = on_interrupt;
	if (!hook(cpu, UC_HOOK_INTR, callback.pointer))
		return false;
	callback.on_bad_access = on_store_into_flash;
	if (!hook(cpu, UC_HOOK_MEM_WRITE_PROT, callback.pointer))
		return false;
	callback.on_bad_access = on_bad_access;
	return hook(cpu, UC_HOOK_MEM_INVALID & ~UC_HOOK_MEM_WRITE_PROT, callback.pointer);
}
