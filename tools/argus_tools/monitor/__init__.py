# SPDX-License-Identifier: MIT
"""The live page: a local web server that shows a robot and takes orders, a client of argusd's control socket."""
