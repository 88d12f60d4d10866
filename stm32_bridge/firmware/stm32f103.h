/* SPDX-License-Identifier: MIT
 * The registers of the STM32F103 that the firmware uses. Names, addresses and bits are those of the reference
 * manual (RM0008) and the Cortex-M3 programming manual (PM0056).
 */
#ifndef STM32F103_H
#define STM32F103_H

#include <stdint.h>

#define BIT(n) (UINT32_C(1) << (n))

/* ------------------------------------------------------------------------------- reset and clock control */

struct rcc {
	volatile uint32_t cr, cfgr, cir, apb2rstr, apb1rstr, ahbenr, apb2enr, apb1enr, bdcr, csr;
};
#define RCC ((struct rcc *)0x40021000u)
#define RCC_CR_HSION BIT(0)
#define RCC_CR_HSIRDY BIT(1)
#define RCC_CR_HSEON BIT(16)
#define RCC_CR_HSERDY BIT(17)
#define RCC_CR_PLLON BIT(24)
#define RCC_CR_PLLRDY BIT(25)
#define RCC_CFGR_SW_PLL 2u
#define RCC_CFGR_SWS 0xCu
#define RCC_CFGR_SWS_PLL 0x8u
#define RCC_CFGR_PPRE1_HALF (4u << 8)
#define RCC_CFGR_PLLSRC_HSE BIT(16)
#define RCC_CFGR_PLLMUL(times) (((times) - 2u) << 18)
#define RCC_AHBENR_DMA1EN BIT(0)
#define RCC_AHBENR_CRCEN BIT(6)
#define RCC_APB2ENR_AFIOEN BIT(0)
#define RCC_APB2ENR_IOPAEN BIT(2)
#define RCC_APB2ENR_IOPBEN BIT(3)
#define RCC_APB2ENR_IOPCEN BIT(4)
#define RCC_APB2ENR_SPI1EN BIT(12)
#define RCC_APB2ENR_USART1EN BIT(14)
#define RCC_CSR_RMVF BIT(24)
#define RCC_CSR_PORRSTF BIT(27)
#define RCC_CSR_SFTRSTF BIT(28)
#define RCC_CSR_IWDGRSTF BIT(29)
#define RCC_CSR_WWDGRSTF BIT(30)
#define RCC_CSR_LPWRRSTF BIT(31)

struct flash {
	volatile uint32_t acr, keyr, optkeyr, sr, cr, ar;
};
#define FLASH ((struct flash *)0x40022000u)
#define FLASH_ACR_2_WAITS 2u
#define FLASH_ACR_PREFETCH BIT(4)
#define FLASH_KEY1 0x45670123u
#define FLASH_KEY2 0xCDEF89ABu
#define FLASH_SR_BSY BIT(0)
#define FLASH_SR_PGERR BIT(2)
#define FLASH_SR_WRPRTERR BIT(4)
#define FLASH_SR_EOP BIT(5)
#define FLASH_CR_PG BIT(0)
#define FLASH_CR_PER BIT(1)
#define FLASH_CR_STRT BIT(6)
#define FLASH_CR_LOCK BIT(7)
#define FLASH_PAGE_BYTES 1024u
#define FLASH_KILOBYTES (*(volatile const uint16_t *)0x1FFFF7E0u)

/* --------------------------------------------------------------------------------------------------- pins */

struct gpio {
	volatile uint32_t crl, crh, idr, odr, bsrr, brr, lckr;
};
#define GPIOA ((struct gpio *)0x40010800u)
#define GPIOB ((struct gpio *)0x40010C00u)
#define GPIOC ((struct gpio *)0x40011000u)

/* The four bits of a pin in CRL (pins 0 to 7) and CRH (8 to 15). */
#define GPIO_INPUT 0x4u
#define GPIO_INPUT_PULL 0x8u /* up or down by ODR */
#define GPIO_OUTPUT_2MHZ 0x2u
#define GPIO_OUTPUT_50MHZ 0x3u
#define GPIO_FUNCTION_50MHZ 0xBu /* push-pull output of a peripheral */

#define AFIO_EXTICR1 (*(volatile uint32_t *)0x40010008u)
#define AFIO_EXTICR1_EXTI0_PB 1u

struct exti {
	volatile uint32_t imr, emr, rtsr, ftsr, swier, pr;
};
#define EXTI ((struct exti *)0x40010400u)

/* ----------------------------------------------------------------------------------------- DMA, SPI, CRC */

struct dma_channel {
	volatile uint32_t ccr, cndtr, cpar, cmar, reserved;
};
struct dma {
	volatile uint32_t isr, ifcr;
	struct dma_channel channel[7]; /* [0] is channel 1 */
};
#define DMA1 ((struct dma *)0x40020000u)
#define DMA_CCR_EN BIT(0)
#define DMA_CCR_TCIE BIT(1)
#define DMA_CCR_FROM_MEMORY BIT(4)
#define DMA_CCR_CIRCULAR BIT(5)
#define DMA_CCR_MINC BIT(7)
#define DMA_CCR_PSIZE_16 (1u << 8)
#define DMA_CCR_MSIZE_16 (1u << 10)
#define DMA_CCR_PRIORITY_HIGH (2u << 12)
#define DMA_CCR_PRIORITY_VERY_HIGH (3u << 12)
#define DMA_ISR_TCIF(channel) BIT(4u * ((channel) - 1u) + 1u)
#define DMA_IFCR_CGIF(channel) BIT(4u * ((channel) - 1u))

struct spi {
	volatile uint32_t cr1, cr2, sr, dr;
};
#define SPI1 ((struct spi *)0x40013000u)
#define SPI_CR1_MSTR BIT(2)
#define SPI_CR1_BR_QUARTER (1u << 3)
#define SPI_CR1_BR_EIGHTH (2u << 3)
#define SPI_CR1_SPE BIT(6)
#define SPI_CR1_SSI BIT(8)
#define SPI_CR1_SSM BIT(9)
#define SPI_CR1_DFF_16 BIT(11)
#define SPI_CR2_RXDMAEN BIT(0)
#define SPI_CR2_TXDMAEN BIT(1)
#define SPI_SR_BSY BIT(7)

struct crc {
	volatile uint32_t dr, idr, cr;
};
#define CRC ((struct crc *)0x40023000u)
#define CRC_CR_RESET BIT(0)

/* ------------------------------------------------------------------------------------- serial, watchdog */

struct usart {
	volatile uint32_t sr, dr, brr, cr1, cr2, cr3, gtpr;
};
#define USART1 ((struct usart *)0x40013800u)
#define USART_SR_FE BIT(1)
#define USART_SR_NE BIT(2)
#define USART_SR_ORE BIT(3)
#define USART_SR_RXNE BIT(5)
#define USART_SR_TC BIT(6)
#define USART_SR_TXE BIT(7)
#define USART_CR1_RE BIT(2)
#define USART_CR1_TE BIT(3)
#define USART_CR1_TXEIE BIT(7)
#define USART_CR1_UE BIT(13)
#define USART_CR3_EIE BIT(0)
#define USART_CR3_DMAR BIT(6)

struct iwdg {
	volatile uint32_t kr, pr, rlr, sr;
};
#define IWDG ((struct iwdg *)0x40003000u)
#define IWDG_KR_FEED 0xAAAAu
#define IWDG_KR_UNLOCK 0x5555u
#define IWDG_KR_START 0xCCCCu
#define IWDG_PR_16 2u

#define DBGMCU_CR (*(volatile uint32_t *)0xE0042004u)
#define DBGMCU_CR_IWDG_STOP BIT(8)

/* -------------------------------------------------------------------------------------------------- core */

struct systick {
	volatile uint32_t csr, rvr, cvr, calib;
};
#define SYSTICK ((struct systick *)0xE000E010u)
#define SYSTICK_CSR_ENABLE BIT(0)
#define SYSTICK_CSR_TICKINT BIT(1)
#define SYSTICK_CSR_CPU_CLOCK BIT(2)

#define NVIC_ISER ((volatile uint32_t *)0xE000E100u)
#define NVIC_IPR ((volatile uint8_t *)0xE000E400u)
#define IRQ_EXTI0 6u
#define IRQ_DMA1_CHANNEL5 15u
#define IRQ_USART1 37u
#define IRQ_COUNT 43u /* of the medium-density devices */

#define SCB_VTOR (*(volatile uint32_t *)0xE000ED08u)
#define SCB_AIRCR (*(volatile uint32_t *)0xE000ED0Cu)
#define SCB_AIRCR_SYSRESETREQ 0x05FA0004u
#define SCB_SHPR3_SYSTICK (*(volatile uint8_t *)0xE000ED23u)

static inline void irq_disable(void)
{
	__asm volatile("cpsid i" ::: "memory");
}

static inline void irq_enable(void)
{
	__asm volatile("cpsie i" ::: "memory");
}

/* Sleeps until an interrupt is pending, even if interrupts are disabled. */
static inline void wait_for_interrupt(void)
{
	__asm volatile("dsb\n\twfi" ::: "memory");
}

/* Enables an interrupt; priority 0 .. 15, 0 is the highest. */
static inline void nvic_enable(unsigned irq, unsigned priority)
{
	NVIC_IPR[irq] = (uint8_t)(priority << 4);
	NVIC_ISER[irq / 32u] = BIT(irq % 32u);
}

/* Sets the mode of pin 0 .. 15 of a port. */
static inline void gpio_mode(struct gpio *port, unsigned pin, uint32_t mode)
{
	volatile uint32_t *cr = pin < 8u ? &port->crl : &port->crh;
	unsigned shift = pin % 8u * 4u;

	*cr = (*cr & ~(0xFu << shift)) | mode << shift;
}

#endif
