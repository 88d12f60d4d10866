/* SPDX-License-Identifier: MIT
 * Priorities, nesting, tail-chaining, masks, SVC and PendSV. Each handler notes its beginning (0x1n) and its
 * end (0x2n).
 */
#include "machine.h"

static volatile bool provoke;

void interrupt_0_handler(void)
{
	note(0x10);
	if (provoke) {
		NVIC_ISPR(0) = 2; /* more urgent: immediately */
		NVIC_ISPR(0) = 4; /* less urgent: afterwards */
	}
	note(0x20);
}

void interrupt_1_handler(void)
{
	note(0x11);
	SCB_ICSR = 1u << 28; /* least urgent: last */
	note(0x21);
}

void interrupt_2_handler(void)
{
	note(0x12);
	note(0x22);
}

void pend_handler(void)
{
	note(0x14);
}

void supervisor_handler(void)
{
	note(0x13);
}

/* An exception in an IT block, and registers and flags that survive exceptions. */
static uint32_t sum_with_exceptions(void)
{
	uint32_t sum = 0;

	for (uint32_t i = 0; i < 1000; i++)
		__asm volatile("tst %1, #3\n"
			       "itete eq\n"
			       "addeq %0, #5\n"
			       "addne %0, #1\n"
			       "eoreq %0, %1\n"
			       "addne %0, #7\n"
		    : "+r"(sum)
		    : "r"(i)
		    : "cc");
	return sum;
}

volatile uint32_t ticks, sum_in_peace, sum_under_fire;

void systick_handler(void)
{
	ticks++;
}

int main(void)
{
	NVIC_PRIORITY(0) = 0x80;
	NVIC_PRIORITY(1) = 0x40;
	NVIC_PRIORITY(2) = 0xC0;
	SCB_SHPR3 = 0x30F00000;
	NVIC_ISER(0) = 7;

	NVIC_ISPR(0) = 1;
	note(1);
	provoke = true;
	NVIC_ISPR(0) = 1;
	note(2);
	provoke = false;

	disable_interrupts();
	NVIC_ISPR(0) = 5;
	note(3);
	enable_interrupts();
	note(4);
	__asm volatile("msr basepri, %0" ::"r"(0x80));
	NVIC_ISPR(0) = 4;
	NVIC_ISPR(0) = 2;
	note(5);
	__asm volatile("msr basepri, %0" ::"r"(0));
	note(6);
	__asm volatile("svc 0");
	note(7);

	disable_interrupts(); /* WFI ends in spite of PRIMASK, without the handler */
	NVIC_ISPR(0) = 1;
	sleep();
	note(8);
	enable_interrupts();
	note(9);

	sum_in_peace = sum_with_exceptions();
	SYSTICK_LOAD = 66;
	SYSTICK_VAL = 0;
	SYSTICK_CTRL = 7;
	sum_under_fire = sum_with_exceptions();
	SYSTICK_CTRL = 0;
	return 0;
}
