# Timing of Passo for Vivado. Other tools have passo.sdc.
#
# Ports have the names that the core gives them. Cells are found wherever the core is in the hierarchy. Give the
# figures of your design here; all are ns. docs/integration.md tells what is behind each line.

set clk_period   10.0 ;# of clk
set sclk_period  40.0 ;# of the fastest SCLK: at least four times that of clk
set mosi_delay   10.0 ;# host and cable: from the falling edge of SCLK at the FPGA until MOSI is there
set miso_delay   10.0 ;# cable and set-up time of the host: MISO leaves the FPGA so long before SCLK rises

# Leave the first one out if an MMCM or PLL makes clk. SCLK needs a clock-capable pin.
create_clock -name clk -period $clk_period [get_ports clk]
create_clock -name spi_sclk -period $sclk_period [get_ports spi_sclk]

# SPI mode 0: both sides change their data after the falling edge of SCLK, and take them with the rising one.
set_input_delay -max $mosi_delay -clock spi_sclk -clock_fall [get_ports spi_mosi]
set_input_delay -min 0 -clock spi_sclk -clock_fall [get_ports spi_mosi]
set_output_delay -max $miso_delay -clock spi_sclk [get_ports spi_miso]
set_output_delay -min 0 -clock spi_sclk [get_ports spi_miso]

# Asynchronous: chip select moves while SCLK rests, and has a synchroniser for clk; so has sync.
set_false_path -from [get_ports {spi_cs_n sync}]

# SCLK to clk: half_toggle announces half and half_low, which stay; they have the time its synchroniser takes.
set_max_delay -datapath_only $clk_period \
    -from [get_cells -hierarchical -filter {NAME =~ *u_spi/half_toggle_reg}] \
    -to [get_cells -hierarchical -filter {NAME =~ *u_spi/toggle_sync_reg[0]}]
set_max_delay -datapath_only $clk_period \
    -from [get_cells -hierarchical -filter {NAME =~ *u_spi/half_reg[*] || NAME =~ *u_spi/half_low_reg}]

# clk to SCLK: the reply stands long before the falling edge that takes it.
set_max_delay -datapath_only $clk_period \
    -from [get_cells -hierarchical -filter {NAME =~ *u_reply/word_reg[*]}] \
    -to [get_cells -hierarchical -filter {NAME =~ *u_spi/shift_reg[*] || NAME =~ *u_spi/spi_miso_reg}]

# All pins of the drives are late by about the same, which no drive notices.
set_false_path -to [get_ports {step[*] dir[*] enable[*] running[*] irq}]
