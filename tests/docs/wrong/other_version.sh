#!/bin/sh
echo "pkmopt 99.0 (revision)"
