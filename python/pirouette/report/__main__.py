import sys

from pirouette.report import main

sys.exit(main())
