import sys

from pirouette.view import main

sys.exit(main())
