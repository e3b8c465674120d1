# The spelling of the course sheet: loads animate_pendulum.plt from the same folder.
load ARG0[1 : strlen(ARG0) - strlen("animate pendulum.plt")] . "animate_pendulum.plt"
