import sys

from pirouette.export import main

sys.exit(main())
