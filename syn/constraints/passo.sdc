# Timing constraints of Passo for tools that read SDC, such as Quartus, Efinity, Radiant or Gowin's. For Vivado use
# passo.xdc.
#
# Ports have the names of the core. Cell patterns match at any level of the hierarchy and with any suffix that a tool
# adds to register names. Set the values of your design here, in ns. docs/integration.md explains each line.

set clk_period   10.0 ;# of clk
set sclk_period  40.0 ;# of the fastest SCLK: at least four times that of clk
set mosi_delay   10.0 ;# host and cable: from the falling edge of SCLK at the FPGA until MOSI is valid
set miso_delay   10.0 ;# cable and setup time of the host: from MISO at the FPGA to the rising edge of SCLK

# If a PLL generates clk, omit the first line and use the name of its clock instead of clk below.
create_clock -name clk -period $clk_period [get_ports clk]
create_clock -name spi_sclk -period $sclk_period [get_ports spi_sclk]

# SPI mode 0: both sides change data after the falling edge of SCLK and sample with the rising edge.
set_input_delay -max $mosi_delay -clock spi_sclk -clock_fall [get_ports spi_mosi]
set_input_delay -min 0 -clock spi_sclk -clock_fall [get_ports spi_mosi]
set_output_delay -max $miso_delay -clock spi_sclk [get_ports spi_miso]
set_output_delay -min 0 -clock spi_sclk [get_ports spi_miso]

# Asynchronous: chip select changes while SCLK is idle and has a synchronizer for clk, as have sync and the inputs of
# the machine.
set_false_path -from [get_ports {spi_cs_n sync estop_n limit_low* limit_high* home* alarm* probe*}]
set_false_path -from [get_ports {encoder_a* encoder_b* encoder_index*}]

# SCLK to clk: half_toggle signals that half and half_low are stable; they have the latency of its
# synchronizer.
set_max_delay $clk_period -from [get_cells {*u_spi*half*}] -to [get_clocks clk]

# clk to SCLK: the reply is stable long before the falling edge that loads it into shift and spi_miso.
set_max_delay $clk_period -from [get_cells {*u_reply*word*}] -to [get_clocks spi_sclk]

# No hold requirements between the domains.
set_false_path -hold -from [get_clocks clk] -to [get_clocks spi_sclk]
set_false_path -hold -from [get_clocks spi_sclk] -to [get_clocks clk]

# The drive pins are asynchronous to their receivers.
set_false_path -to [get_ports {step* dir* enable* running* irq outputs* power* compare*}]
