/* SPDX-License-Identifier: MIT */
#include <string.h>

#include "board.h"

#include "stm32f103.h"

#define HSE_HZ 8000000u
#define HSI_HZ 8000000u
#define HSE_WAIT 200000u /* polls, more than 50 ms; a crystal needs 2 ms */
#define LED_PIN 13u      /* of port C, active low */
#define CORE_PIN 0u      /* of port B */
#define FAULT_MAGIC 0x46415554u
#define GUARD 0xDEADC0DEu

enum { PRIORITY_SERIAL = 1, PRIORITY_TICK = 2, PRIORITY_CORE = 3 };

extern uint32_t ram_used_end[]; /* lowest word of the stack area */

static uint32_t clock_hz;
static volatile uint32_t milliseconds;
static const char *reset_cause;
static struct board_fault last_fault;

/* Not initialized, so that it survives a reset. */
static struct {
	uint32_t magic, exception, address, check;
} noted_fault __attribute__((section(".noinit")));

static bool wait_for(const volatile uint32_t *reg, uint32_t mask, uint32_t value, uint32_t rounds)
{
	while ((*reg & mask) != value) {
		if (rounds-- == 0u)
			return false;
	}
	return true;
}

uint32_t board_flash_kilobytes(void)
{
	return FLASH_KILOBYTES;
}

const char *board_chip(void)
{
	return FLASH_KILOBYTES >= 128u ? "STM32F103xB" : "STM32F103x8";
}

bool board_was_off(void)
{
	return (RCC->csr & RCC_CSR_PORRSTF) != 0u;
}

/* Switches from the internal oscillator to the PLL. Returns whether there is a crystal. */
static bool start_clocks(void)
{
	uint32_t cfgr = RCC_CFGR_PPRE1_HALF; /* APB1 allows 36 MHz */
	bool crystal;

	RCC->cr |= RCC_CR_HSEON;
	crystal = wait_for(&RCC->cr, RCC_CR_HSERDY, RCC_CR_HSERDY, HSE_WAIT);
	if (crystal) {
		cfgr |= RCC_CFGR_PLLSRC_HSE | RCC_CFGR_PLLMUL(9u);
		clock_hz = 9u * HSE_HZ;
	} else {
		RCC->cr &= ~RCC_CR_HSEON;
		cfgr |= RCC_CFGR_PLLMUL(16u); /* of HSI / 2 */
		clock_hz = 16u * (HSI_HZ / 2u);
	}
	FLASH->acr = FLASH_ACR_PREFETCH | FLASH_ACR_2_WAITS;
	RCC->cfgr = cfgr;
	RCC->cr |= RCC_CR_PLLON;
	if (!wait_for(&RCC->cr, RCC_CR_PLLRDY, RCC_CR_PLLRDY, HSE_WAIT))
		board_reset();
	RCC->cfgr = cfgr | RCC_CFGR_SW_PLL;
	if (!wait_for(&RCC->cfgr, RCC_CFGR_SWS, RCC_CFGR_SWS_PLL, HSE_WAIT))
		board_reset();
	return crystal;
}

static void read_reset_cause(void)
{
	static const struct {
		uint32_t flag;
		const char *name;
	} CAUSES[] = {
	    {RCC_CSR_LPWRRSTF, "low power"},
	    {RCC_CSR_WWDGRSTF, "window watchdog"},
	    {RCC_CSR_IWDGRSTF, "watchdog"},
	    {RCC_CSR_SFTRSTF, "software"},
	    {RCC_CSR_PORRSTF, "power"},
	};
	uint32_t flags = RCC->csr;

	RCC->csr |= RCC_CSR_RMVF;
	reset_cause = "pin"; /* every other cause sets this flag as well */
	for (unsigned i = 0; i < sizeof CAUSES / sizeof CAUSES[0]; i++) {
		if ((flags & CAUSES[i].flag) != 0u) {
			reset_cause = CAUSES[i].name;
			break;
		}
	}
	if (noted_fault.magic == FAULT_MAGIC
	    && noted_fault.check == (noted_fault.exception ^ noted_fault.address ^ FAULT_MAGIC)) {
		last_fault = (struct board_fault){noted_fault.exception, noted_fault.address};
		reset_cause = "fault";
	}
	noted_fault.magic = 0;
}

bool board_start(void)
{
	bool crystal = start_clocks();

	ram_used_end[0] = GUARD;
	RCC->apb2enr |= RCC_APB2ENR_AFIOEN | RCC_APB2ENR_IOPAEN | RCC_APB2ENR_IOPBEN | RCC_APB2ENR_IOPCEN;
	read_reset_cause();

	GPIOC->bsrr = BIT(LED_PIN);
	gpio_mode(GPIOC, LED_PIN, GPIO_OUTPUT_2MHZ);

	gpio_mode(GPIOB, CORE_PIN, GPIO_INPUT_PULL);
	GPIOB->bsrr = BIT(CORE_PIN + 16u);
	AFIO_EXTICR1 = AFIO_EXTICR1_EXTI0_PB;
	EXTI->rtsr = BIT(CORE_PIN);
	EXTI->imr = BIT(CORE_PIN);
	nvic_enable(IRQ_EXTI0, PRIORITY_CORE);
	nvic_enable(IRQ_DMA1_CHANNEL5, PRIORITY_SERIAL);
	nvic_enable(IRQ_USART1, PRIORITY_SERIAL);

	SCB_SHPR3_SYSTICK = PRIORITY_TICK << 4;
	SYSTICK->rvr = clock_hz / 1000u - 1u;
	SYSTICK->cvr = 0;
	SYSTICK->csr = SYSTICK_CSR_ENABLE | SYSTICK_CSR_TICKINT | SYSTICK_CSR_CPU_CLOCK;
	return crystal;
}

uint32_t board_clock_hz(void)
{
	return clock_hz;
}

void systick_handler(void)
{
	milliseconds++;
}

uint32_t board_milliseconds(void)
{
	return milliseconds;
}

/* Reads again if a tick comes between the two readings. Not for interrupt handlers. */
uint32_t board_microseconds(void *context)
{
	(void)context;
	uint32_t before, left;

	do {
		before = milliseconds;
		left = SYSTICK->cvr;
		__asm volatile("isb" ::: "memory"); /* a pending tick is taken here */
	} while (before != milliseconds);
	return before * 1000u + (SYSTICK->rvr - left) / (clock_hz / 1000000u);
}

const char *board_reset_cause(void)
{
	return reset_cause;
}

struct board_fault board_last_fault(void)
{
	return last_fault;
}

void board_note_fault(uint32_t exception, uint32_t address)
{
	noted_fault.exception = exception;
	noted_fault.address = address;
	noted_fault.check = exception ^ address ^ FAULT_MAGIC;
	noted_fault.magic = FAULT_MAGIC;
}

void board_reset(void)
{
	__asm volatile("dsb" ::: "memory");
	SCB_AIRCR = SCB_AIRCR_SYSRESETREQ;
	for (;;)
		continue;
}

/* 2500 ticks of 40 kHz / 16; the oscillator has 30 to 60 kHz. The two registers are updated with a delay;
 * their reset values, valid until then, exceed the startup time of the firmware. */
void board_watchdog_start(void)
{
	DBGMCU_CR |= DBGMCU_CR_IWDG_STOP;
	IWDG->kr = IWDG_KR_START;
	IWDG->kr = IWDG_KR_UNLOCK;
	IWDG->pr = IWDG_PR_16;
	IWDG->rlr = 2500u;
	wait_for(&IWDG->sr, 3u, 0u, HSE_WAIT);
	IWDG->kr = IWDG_KR_FEED;
}

void board_watchdog_feed(void)
{
	if (ram_used_end[0] == GUARD)
		IWDG->kr = IWDG_KR_FEED;
}

void board_led(bool fault)
{
	uint32_t phase = milliseconds % 1024u;
	bool on = fault ? phase % 128u < 64u : phase < 64u;

	GPIOC->bsrr = on ? BIT(LED_PIN + 16u) : BIT(LED_PIN);
}

void exti0_handler(void)
{
	EXTI->pr = BIT(CORE_PIN); /* its only purpose is to wake the main loop */
}

bool board_core_calls(void *context)
{
	(void)context;
	return (GPIOB->idr & BIT(CORE_PIN)) != 0u;
}

void board_sleep(void)
{
	wait_for_interrupt();
}

/* That of newlib compares words at a time, in 440 bytes. */
int strcmp(const char *a, const char *b)
{
	while (*a != '\0' && *a == *b) {
		a++;
		b++;
	}
	return (unsigned char)*a - (unsigned char)*b;
}
