// Whether samples are what rays of other samples have met, in place of what the camera sees. Pipelines are compiled for it.

override AT_HITS: bool = false;
