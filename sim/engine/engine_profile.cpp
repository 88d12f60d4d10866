/* SPDX-License-Identifier: MIT
 * A core at rest, for the profile of the compiler: most of its branches go as they nearly always do.
 */
#include "Vpasso_spi_top.h"
#include "passo_pins.h"
#include "verilated.h"

int main()
{
	const passo_inputs inputs = PASSO_INPUTS_IDLE;
	VerilatedContext context;
	Vpasso_spi_top top{&context};

#define SET(name, type, number) top.name = inputs.name;
	PASSO_INPUTS(SET)
#undef SET
	top.limit = 4096;
	for (int i = 0; i < 8; i++) {
		top.rst = i < 2;
		top.eval();
		top.go = !top.go;
		top.eval();
	}
	top.final();
	return 0;
}
