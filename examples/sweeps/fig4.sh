#!/bin/sh
# Fig. 4 of the paper: COR of the SLS impact against velocity, beta as a parameter and
# alpha/beta = 1/4. The two change together, so each beta is a run of its own.
# Prints beta [1/s], velocity [m/s] and COR, a line per impact. Needs vcor in the PATH.
set -e
case=$(dirname "$0")/sls_velocity.nml
for beta in 600 1200 2400 4800; do
   vcor run "$case" --set rubber.beta=$beta --set rubber.alpha=$((beta / 4)) \
      --print impact.velocity,cor | sed "s/^/$beta /"
done
