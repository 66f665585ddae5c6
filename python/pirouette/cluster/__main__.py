import sys

from pirouette.cluster import main

sys.exit(main())
