/* SPDX-License-Identifier: MIT
 * A Cortex-M3 on unicorn, see passo_cpu.h.
 */
#include <stdlib.h>
#include <string.h>
#include <unicorn/unicorn.h>

#include "passo_cpu.h"

#define FLASH 0x08000000u
#define RAM 0x20000000u
#define NOWHERE 0xFFFFFFF6u /* an address that is never executed */
#define EXCEPTION_CYCLES 12u
#define WAIT_FOR_INTERRUPT 0xBF30u
#define XPSR_THUMB (1u << 24)
#define XPSR_ALIGNED (1u << 9)
#define XPSR_IT 0x0600FC00u
#define FRAME 32u

/* unicorn's numbers of these exceptions */
#define INTERRUPT_SVC 2u
#define INTERRUPT_EXCEPTION_EXIT 8u

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

static struct cpu *whole(struct passo_cpu *cpu)
{
	return (struct cpu *)cpu;
}

static void stop(struct cpu *cpu, enum passo_cpu_stop reason)
{
	cpu->stop = reason;
	uc_emu_stop(cpu->uc);
}

uint8_t *passo_cpu_memory(struct passo_cpu *cpu, uint32_t address, uint32_t *size)
{
	struct cpu *own = whole(cpu);

	if (address < own->config.flash_size)
		address += FLASH;
	if (address >= FLASH && address - FLASH < own->config.flash_size) {
		*size = own->config.flash_size - (address - FLASH);
		return own->flash + (address - FLASH);
	}
	if (address >= RAM && address - RAM < own->config.ram_size) {
		*size = own->config.ram_size - (address - RAM);
		return own->ram + (address - RAM);
	}
	*size = 0;
	return NULL;
}

static uint32_t load(struct cpu *cpu, uint32_t address)
{
	uint32_t size, word = 0;
	const uint8_t *from = passo_cpu_memory(&cpu->public, address, &size);

	if (from && size >= sizeof word)
		memcpy(&word, from, sizeof word);
	return word;
}

/* Accounts for an instruction: time and profile. */
static void count(struct cpu *cpu, uint32_t address)
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

/* After a store into flash: what it has become. */
static void settle(struct cpu *cpu)
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
	settle(cpu);
	if (cpu->held)
		count(cpu, cpu->held_address);
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
		count(cpu, (uint32_t)address);
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

/* unicorn may store the value as well when this has returned true: settle() undoes it. */
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

static bool open_unicorn(struct cpu *cpu)
{
	const struct passo_cpu_config *config = &cpu->config;
	const uint32_t code = UC_PROT_READ | UC_PROT_EXEC;
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
	    || uc_mem_map_ptr(cpu->uc, FLASH, config->flash_size, code, cpu->flash) != UC_ERR_OK
	    || uc_mem_map_ptr(cpu->uc, RAM, config->ram_size, UC_PROT_ALL, cpu->ram) != UC_ERR_OK
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
	if (!open_unicorn(cpu)) {
		passo_cpu_destroy(&cpu->public);
		return NULL;
	}
	return &cpu->public;
}

void passo_cpu_destroy(struct passo_cpu *cpu)
{
	struct cpu *own = whole(cpu);

	if (!cpu)
		return;
	if (own->uc)
		uc_close(own->uc);
	free(own->flash);
	free(own->ram);
	free(own);
}

static uint32_t get(struct cpu *cpu, int id)
{
	uint32_t value = 0;

	uc_reg_read(cpu->uc, id, &value);
	return value;
}

static void set(struct cpu *cpu, int id, uint32_t value)
{
	uc_reg_write(cpu->uc, id, &value);
}

void passo_cpu_set_pc(struct passo_cpu *cpu, uint32_t address)
{
	set(whole(cpu), UC_ARM_REG_PC, address | 1u);
}

void passo_cpu_reset(struct passo_cpu *cpu)
{
	struct cpu *own = whole(cpu);

	for (int id = UC_ARM_REG_R0; id <= UC_ARM_REG_R12; id++)
		set(own, id, 0);
	set(own, UC_ARM_REG_PRIMASK, 0);
	set(own, UC_ARM_REG_FAULTMASK, 0);
	set(own, UC_ARM_REG_BASEPRI, 0);
	set(own, UC_ARM_REG_CONTROL, 0);
	set(own, UC_ARM_REG_XPSR, XPSR_THUMB);
	set(own, UC_ARM_REG_IPSR, 0);
	set(own, UC_ARM_REG_SP, load(own, 0) & ~3u);
	set(own, UC_ARM_REG_LR, 0xFFFFFFFF);
	passo_cpu_set_pc(cpu, load(own, 4));
	own->may_unmask = false;
}

enum passo_cpu_stop passo_cpu_run(struct passo_cpu *cpu)
{
	struct cpu *own = whole(cpu);
	uc_err error;

	own->held = false;
	own->stop = PASSO_CPU_FAULT;
	cpu->fault = 0;
	cpu->fault_address = 0;
	error = uc_emu_start(own->uc, get(own, UC_ARM_REG_PC) | 1u, NOWHERE, 0, 0);
	settle(own);
	if (error != UC_ERR_OK) {
		cpu->fault = (int32_t)error;
		return PASSO_CPU_FAULT;
	}
	if (own->held && own->held_address != get(own, UC_ARM_REG_PC))
		count(own, own->held_address);
	if (own->stop == PASSO_CPU_SLEEP)
		passo_cpu_set_pc(cpu, get(own, UC_ARM_REG_PC) + 2);
	return own->stop;
}

void passo_cpu_enter(struct passo_cpu *cpu, uint32_t exception, uint32_t handler)
{
	struct cpu *own = whole(cpu);
	const uint32_t sp = get(own, UC_ARM_REG_SP), aligned = (sp - FRAME) & ~7u;
	uint32_t size, xpsr = get(own, UC_ARM_REG_XPSR) | XPSR_THUMB;
	uint8_t *to = passo_cpu_memory(cpu, aligned, &size);
	uint32_t frame[FRAME / 4] = {get(own, UC_ARM_REG_R0), get(own, UC_ARM_REG_R1),
	    get(own, UC_ARM_REG_R2), get(own, UC_ARM_REG_R3), get(own, UC_ARM_REG_R12),
	    get(own, UC_ARM_REG_LR), get(own, UC_ARM_REG_PC) & ~1u,
	    (xpsr & ~XPSR_ALIGNED) | (aligned + FRAME == sp ? 0 : XPSR_ALIGNED)};

	if (to && size >= FRAME)
		memcpy(to, frame, FRAME);
	set(own, UC_ARM_REG_SP, aligned);
	set(own, UC_ARM_REG_LR, xpsr & 0x1FF ? 0xFFFFFFF1 : 0xFFFFFFF9);
	set(own, UC_ARM_REG_XPSR, (xpsr & ~(XPSR_IT | 0x1FFu)) | exception);
	set(own, UC_ARM_REG_IPSR, exception);
	passo_cpu_set_pc(cpu, handler);
	cpu->now += EXCEPTION_CYCLES * cpu->step;
}

bool passo_cpu_return(struct passo_cpu *cpu)
{
	struct cpu *own = whole(cpu);
	const uint32_t value = get(own, UC_ARM_REG_PC) | 1u, sp = get(own, UC_ARM_REG_SP);
	uint32_t size, frame[FRAME / 4];
	const uint8_t *from = passo_cpu_memory(cpu, sp, &size);

	if (!from || size < FRAME)
		return false;
	memcpy(frame, from, FRAME);
	if (value != (frame[7] & 0x1FF ? 0xFFFFFFF1 : 0xFFFFFFF9))
		return false;
	set(own, UC_ARM_REG_R0, frame[0]);
	set(own, UC_ARM_REG_R1, frame[1]);
	set(own, UC_ARM_REG_R2, frame[2]);
	set(own, UC_ARM_REG_R3, frame[3]);
	set(own, UC_ARM_REG_R12, frame[4]);
	set(own, UC_ARM_REG_LR, frame[5]);
	set(own, UC_ARM_REG_SP, sp + FRAME + (frame[7] & XPSR_ALIGNED ? 4 : 0));
	set(own, UC_ARM_REG_IPSR, frame[7] & 0x1FF);
	set(own, UC_ARM_REG_XPSR, frame[7] & ~XPSR_ALIGNED);
	passo_cpu_set_pc(cpu, frame[6]);
	cpu->now += EXCEPTION_CYCLES * cpu->step;
	return true;
}

uint32_t passo_cpu_ipsr(struct passo_cpu *cpu)
{
	return get(whole(cpu), UC_ARM_REG_IPSR) & 0x1FF;
}

uint32_t passo_cpu_masks(struct passo_cpu *cpu)
{
	struct cpu *own = whole(cpu);

	return (get(own, UC_ARM_REG_PRIMASK) & 1) | (get(own, UC_ARM_REG_FAULTMASK) & 1) << 1
	     | (get(own, UC_ARM_REG_CONTROL) & 3) << 8 | (get(own, UC_ARM_REG_BASEPRI) & 0xFF) << 16;
}

void passo_cpu_registers(struct passo_cpu *cpu, uint32_t values[PASSO_CPU_REGISTERS])
{
	struct cpu *own = whole(cpu);

	for (int i = 0; i <= 12; i++)
		values[i] = get(own, UC_ARM_REG_R0 + i);
	values[13] = get(own, UC_ARM_REG_SP);
	values[14] = get(own, UC_ARM_REG_LR);
	values[15] = get(own, UC_ARM_REG_PC);
	values[16] = get(own, UC_ARM_REG_XPSR);
}
